#include "scene_io/gltf/write/texture_use.h"

#include <cmath>

#include "renderer/base/error.h"
#include "scene_io/gltf/write/member.h"

namespace parian {

using nlohmann::json;

// The reader has (a, b, c; d, e, f) = (cos sx, sin sy, ox; -sin sx, cos sy, oy).
std::optional<TextureTransform> decompose(const std::array<float, 6>& map) {
  const double a = map[0], b = map[1], d = map[3], e = map[4];
  TextureTransform t{{map[2], map[5]}, 0, {a, e}};
  if (b == 0 && d == 0) return t;
  // By the longer of the two columns, so that a scale of 0 does not matter.
  const double first = std::hypot(a, d), second = std::hypot(b, e);
  t.rotation = first >= second ? std::atan2(-d, a) : std::atan2(b, e);
  const double c = std::cos(t.rotation), s = std::sin(t.rotation);
  t.scale[0] = c * a - s * d;
  t.scale[1] = s * b + c * e;
  const double tolerance = 1e-5 * (first + second);
  const bool fits = std::abs(c * t.scale[0] - a) <= tolerance && std::abs(-s * t.scale[0] - d) <= tolerance &&
                    std::abs(s * t.scale[1] - b) <= tolerance && std::abs(c * t.scale[1] - e) <= tolerance;
  if (!fits) return std::nullopt;
  return t;
}

bool TextureUses::is_same(const TextureRef& now, const TextureRef& before) const {
  if (now.uv_set != before.uv_set || now.transform != before.transform || bool(now) != bool(before))
    return false;
  if (!now) return true;
  const GltfSource& source = *draft_.source_of(origin_);
  return draft_.textures[std::size_t(now.texture)] ==
         draft_.merged(origin_, array::kTextures, std::size_t(source.textures[std::size_t(before.texture)]));
}

void TextureUses::set_transform(json& use, const TextureRef& now) const {
  erase_extension(use, "KHR_texture_transform");
  if (now.transform == TextureRef().transform) return;
  const auto t = decompose(now.transform);
  if (!t) {
    throw InputError(draft_.path.string(), fmt::format("/materials/{}", material_),
                     "cannot be written: expected texture transforms without shear");
  }
  json& extension = need_extension(use, "KHR_texture_transform");
  if (t->offset[0] != 0 || t->offset[1] != 0)
    extension["offset"] = {to_json(now.transform[2]), to_json(now.transform[5])};
  if (t->rotation != 0) {
    extension["rotation"] = t->rotation;
    extension["scale"] = {t->scale[0], t->scale[1]};
  } else {
    extension["scale"] = {to_json(now.transform[0]), to_json(now.transform[4])};
  }
}

json* TextureUses::set(json& object, const char* key, const TextureRef& now, const TextureRef& before) const {
  if (!is_same(now, before)) {
    if (!now) {
      object.erase(key);
      return nullptr;
    }
    json& use = object[key];
    if (!use.is_object()) use = json::object();
    use["index"] = draft_.textures[std::size_t(now.texture)];
    if (now.uv_set != before.uv_set || now.transform != before.transform) {
      set_transform(use, now);
      use.erase("texCoord");
      if (now.uv_set != 0) use["texCoord"] = now.uv_set;
    }
  }
  return object.contains(key) ? &object[key] : nullptr;
}

}  // namespace parian
