/// write_materials(): glTF's core, and what calls the extensions.
#include <algorithm>
#include <cmath>
#include <limits>

#include "scene_io/gltf/write/material_extensions.h"
#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

const char* to_gltf(AlphaMode mode) {
  if (mode == AlphaMode::mask) return "MASK";
  return mode == AlphaMode::blend ? "BLEND" : "OPAQUE";
}

bool gives(const Rgb& factor, float strength, const Rgb& emission) { return factor * strength == emission; }

/// Emission as a factor in [0, 1] and the strength that the reader multiplies it by: so that it gives back
/// the same floats, which a division by a power of two always does.
void set_emission(json& target, const Rgb& emission) {
  const float most = std::max({emission.x, emission.y, emission.z});
  float strength = 1;
  if (most > 1) {
    strength = most;
    if (!gives(emission / most, most, emission))
      strength = std::min(std::exp2(std::ceil(std::log2(most))), std::exp2(127.0f));
    if (strength < most) strength = most;
  }
  target["emissiveFactor"] = to_json(emission / strength);
  erase_extension(target, "KHR_materials_emissive_strength");
  if (strength != 1)
    need_extension(target, "KHR_materials_emissive_strength")["emissiveStrength"] = to_json(strength);
}

void write_metallic_roughness(json& target, const Material& now, const Material& before,
                              const TextureUses& textures) {
  json pbr = target.value("pbrMetallicRoughness", json::object());
  if (now.base_color != before.base_color || now.alpha != before.alpha) {
    pbr["baseColorFactor"] = to_json(now.base_color);
    pbr["baseColorFactor"].push_back(to_json(now.alpha));
  }
  textures.set(pbr, "baseColorTexture", now.base_color_texture, before.base_color_texture);
  set_changed(pbr, "metallicFactor", now.metallic, before.metallic);
  set_changed(pbr, "roughnessFactor", now.roughness, before.roughness);
  textures.set(pbr, "metallicRoughnessTexture", now.metallic_roughness_texture,
               before.metallic_roughness_texture);
  if (!pbr.empty() || target.contains("pbrMetallicRoughness"))
    target["pbrMetallicRoughness"] = std::move(pbr);
}

void write_core(json& target, const Material& now, const Material& before, const TextureUses& textures) {
  set_name(target, now.name, before.name);
  write_metallic_roughness(target, now, before, textures);
  if (json* const use = textures.set(target, "normalTexture", now.normal_texture, before.normal_texture))
    set_changed(*use, "scale", now.normal_scale, before.normal_scale);
  if (now.emission != before.emission) set_emission(target, now.emission);
  textures.set(target, "emissiveTexture", now.emission_texture, before.emission_texture);
  if (now.alpha_mode != before.alpha_mode) target["alphaMode"] = to_gltf(now.alpha_mode);
  set_changed(target, "alphaCutoff", now.alpha_cutoff, before.alpha_cutoff);
  set_changed(target, "doubleSided", now.double_sided, before.double_sided);
}

}  // namespace

void write_materials(Draft& draft) {
  const Material none;  // as an empty object reads
  for (std::size_t i = 0; i < draft.scene.materials.size(); ++i) {
    const Material& now = draft.scene.materials[i];
    const Material* const before = draft.before(&Scene::materials, now.origin);
    // The default material of a file is no element of it.
    json& target = need_array(draft.root, array::kMaterials)[i];
    const bool is_new = !before || target.empty();
    const TextureUses textures(draft, i, now.origin);
    write_core(target, now, is_new ? none : *before, textures);
    write_material_extensions(target, now, is_new ? none : *before, textures);
  }
}

}  // namespace parian
