/// Commands on the textures of materials. What is refused is a UsageError, or, of a file that cannot be read,
/// an InputError; then the scene is as it was.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian::edit {

/// The names of all places of a texture that the material has, as "base_color" or "clearcoat.roughness":
/// those of its extensions only where it has them.
std::vector<std::string_view> texture_slots(const Material& material);

/// What the material has there. Throws UsageError where the slot is none of its own, naming those.
const TextureRef& texture_at(const Material& material, std::string_view slot);

/// Reads the image file and puts it into the slot, with a texture of its own, which repeats and filters
/// linearly where there was none, and else is as the old one was. A file that the scene has read before, of
/// equal name and texels, is shared.
void assign_texture(Scene& scene, int material, std::string_view slot, const std::string& path);

/// The same for an image that is there.
void assign_texture(Scene& scene, int material, std::string_view slot, const Image& image);

/// Empties the slot. Texture and image stay in the scene (see remove_unused()).
void remove_texture(Scene& scene, int material, std::string_view slot);

/// How the slot's texture goes on behind its border, and what is between texels. Where other slots have the
/// texture, this one gets one of its own.
struct Sampling {
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
  Filter filter = Filter::linear;
};
void set_sampling(Scene& scene, int material, std::string_view slot, const Sampling& sampling);

/// Which UV set the slot's texture is looked up by: 0 or 1.
void set_uv_set(Scene& scene, int material, std::string_view slot, int uv_set);

}  // namespace parian::edit
