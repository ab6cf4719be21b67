/// read_materials(): metallic-roughness materials and the textures that they use.
#include <cmath>

#include "scene_io/gltf/materials/material_extensions.h"
#include "scene_io/gltf/read.h"

namespace parian {
namespace {

Material read_material(const tinygltf::Material& source, TextureTable& textures) {
  const auto& pbr = source.pbrMetallicRoughness;
  Material material;
  material.name = source.name;
  material.base_color = to_rgb(pbr.baseColorFactor);
  material.alpha = float(pbr.baseColorFactor[3]);
  material.base_color_texture = textures.use(pbr.baseColorTexture);
  material.metallic = float(pbr.metallicFactor);
  material.roughness = float(pbr.roughnessFactor);
  material.metallic_roughness_texture = textures.use(pbr.metallicRoughnessTexture);
  material.normal_texture = textures.use(source.normalTexture);
  material.normal_scale = float(source.normalTexture.scale);
  material.emission = to_rgb(source.emissiveFactor);
  material.emission_texture = textures.use(source.emissiveTexture);
  if (source.alphaMode == "MASK") material.alpha_mode = AlphaMode::mask;
  if (source.alphaMode == "BLEND") material.alpha_mode = AlphaMode::blend;
  material.alpha_cutoff = float(source.alphaCutoff);
  material.double_sided = source.doubleSided;
  read_material_extensions(source.extensions, textures, material);
  return material;
}

/// The turn about +y that takes the image's centre, +x, to the axis that `frontside` names.
Quatf to_rotation(const std::string& frontside) {
  const float half = std::sqrt(0.5f);
  if (frontside == "-X") return {0, 0, 1, 0};
  if (frontside == "+Z") return {half, 0, -half, 0};
  if (frontside == "-Z") return {half, 0, half, 0};
  return {1, 0, 0, 0};
}

void read_environment(const GltfDocument& document, TextureTable& textures, Scene& scene) {
  const int number = default_scene(document);
  if (number == kNone) return;
  Environment& environment = scene.environment;
  const auto& extensions = document.model.scenes[std::size_t(number)].extensions;
  if (const auto* use = find_extension(extensions, "EXT_lights_environment")) {
    const auto& all = document.model.extensions.at("EXT_lights_environment").Get("environments");
    const tinygltf::Value& source = all.Get(index_or_none(*use, "environment"));
    environment.radiance = Rgb(float(number_or(source, "intensity", 1)));
    environment.image = textures.use_image(index_or_none(source, "source"));
    environment.rotation = to_rotation(text_or(source, "frontside", "+X"));
  }
  if (const auto* own = find_extension(extensions, "PARIAN_environment")) {
    if (own->Has("radiance")) environment.radiance = to_rgb(numbers_or(*own, "radiance", {}));
    if (own->Has("rotation")) {
      const auto r = numbers_or(*own, "rotation", {});
      if (std::abs(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3] - 1) > 9e-4) {
        document.fail(fmt::format("/scenes/{}/extensions/PARIAN_environment/rotation", number),
                      "expected a unit quaternion");
      }
      environment.rotation = Quatf(float(r[3]), float(r[0]), float(r[1]), float(r[2]));
    }
  }
}

}  // namespace

int default_material(const GltfDocument& document, Scene& scene) {
  const std::size_t index = document.model.materials.size();
  if (scene.materials.size() == index) scene.materials.emplace_back().name = "default";
  return int(index);
}

UsedTextures read_materials(const GltfDocument& document, const LoadSettings& settings, Scene& scene,
                            Warnings& warnings) {
  TextureTable textures(document, scene, warnings);
  for (const auto& source : document.model.materials)
    scene.materials.push_back(read_material(source, textures));
  read_environment(document, textures, scene);
  scene.images = read_images(document, textures.images(), scene.environment.image, settings);
  return {textures.textures(), textures.images()};
}

}  // namespace parian
