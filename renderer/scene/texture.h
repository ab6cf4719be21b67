/// Texture lookup.
#pragma once

#include "renderer/scene/scene.h"

namespace parian {

enum class ColorSpace : std::uint8_t { linear, srgb };

/// The texel (x, y) as linear RGBA: grey is spread over RGB, missing alpha is 1. `space` applies to the
/// colour channels of integer images; float images are linear already, and alpha always is.
Vec4f texel(const Image& image, int x, int y, ColorSpace space);

/// The texture at uv (v downwards, as glTF has it), wrapped and filtered by its sampler.
Vec4f eval_texture(const Scene& scene, const Texture& texture, const Vec2f& uv, ColorSpace space);

/// The same for a use of a texture: picks the uv set and applies the transform.
Vec4f eval_texture(const Scene& scene, const TextureRef& ref, const std::array<Vec2f, 2>& uvs,
                   ColorSpace space);

}  // namespace parian
