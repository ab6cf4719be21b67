/// How a material uses a texture.
#pragma once

#include <nlohmann/json.hpp>

#include <optional>

#include "scene_io/gltf/write/draft.h"

namespace parian {

/// KHR_texture_transform of an affine map; scale and rotation as exactly as they can be. Nothing where the
/// map shears, which the extension cannot say.
struct TextureTransform {
  double offset[2], rotation, scale[2];
};
std::optional<TextureTransform> decompose(const std::array<float, 6>& map);

/// Writes the uses of textures of one material.
class TextureUses {
 public:
  /// `material`: the material's number, for messages; `origin`: its own.
  TextureUses(const Draft& draft, std::size_t material, const Origin& origin)
      : draft_(draft), material_(material), origin_(origin) {}

  /// Member `key` of `object`. Returns it where there is one, for what else its place adds to it.
  nlohmann::json* set(nlohmann::json& object, const char* key, const TextureRef& now,
                      const TextureRef& before) const;

 private:
  bool is_same(const TextureRef& now, const TextureRef& before) const;
  void set_transform(nlohmann::json& use, const TextureRef& now) const;

  const Draft& draft_;
  std::size_t material_;
  Origin origin_;
};

}  // namespace parian
