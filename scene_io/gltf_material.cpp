/// read_materials(): metallic-roughness materials and the textures that they use.
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "scene_io/gltf_read.h"

namespace parian {
namespace {

Rgb to_rgb(const std::vector<double>& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

/// KHR_texture_transform: offset * rotation * scale, where rotation turns (u, v) as its GLSL matrix says.
std::array<float, 6> to_affine_map(const tinygltf::Value& extension) {
  const auto offset = numbers_or(extension, "offset", {0, 0});
  const auto scale = numbers_or(extension, "scale", {1, 1});
  const double angle = number_or(extension, "rotation", 0);
  const double c = std::cos(angle), s = std::sin(angle);
  // u' = c su u + s sv v + offset; v' = -s su u + c sv v + offset: v grows downwards in an image, so that
  // this is the counter-clockwise turn that the extension describes.
  return {float(c * scale[0]),  float(s * scale[1]), float(offset[0]),
          float(-s * scale[0]), float(c * scale[1]), float(offset[1])};
}

Wrap to_wrap(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat : Wrap::repeat;
}

/// Collects the textures and images in use, in the order in which they are first asked for.
class TextureTable {
 public:
  TextureTable(const GltfDocument& document, Scene& scene, Warnings& warnings)
      : document_(document), scene_(scene), warnings_(warnings) {}

  /// The scene's index of an image of the document. Images with the same source are one.
  int use_image(int image) {
    const auto& source = document_.model.images[std::size_t(image)];
    const auto [found, is_new] = image_of_.try_emplace({source.uri, source.bufferView}, int(images_.size()));
    if (is_new) images_.push_back(image);
    return found->second;
  }

  TextureRef use(int texture, int uv_set, const tinygltf::ExtensionMap& extensions) {
    TextureRef ref{.uv_set = uv_set};
    if (texture < 0) return ref;
    if (const auto* extension = find_extension(extensions, "KHR_texture_transform")) {
      ref.transform = to_affine_map(*extension);
      if (extension->Has("texCoord")) ref.uv_set = index_or_none(*extension, "texCoord");
    }
    if (ref.uv_set > 1) {
      warnings_.add("textures on a third or later set of texture coordinates are not shown");
      return {};
    }
    ref.texture = use_texture(texture);
    return ref;
  }

  template <class Info>
  TextureRef use(const Info& info) {
    return use(info.index, info.texCoord, info.extensions);
  }

  /// A texture inside a material extension.
  TextureRef use(const tinygltf::Value& extension, const char* key) {
    if (!extension.Has(key)) return {};
    const tinygltf::Value& info = extension.Get(key);
    tinygltf::ExtensionMap extensions;
    if (info.Has("extensions")) extensions = info.Get("extensions").Get<tinygltf::Value::Object>();
    return use(index_or_none(info, "index"), int(number_or(info, "texCoord", 0)), extensions);
  }

  /// The images in use, as indices into the document's.
  const std::vector<int>& images() const { return images_; }

 private:
  int use_texture(int number) {
    if (const auto known = texture_of_.find(number); known != texture_of_.end()) return known->second;
    const auto& source = document_.model.textures[std::size_t(number)];
    int image = source.source;
    if (const auto* webp = find_extension(source.extensions, "EXT_texture_webp");
        webp && webp->Has("source")) {
      image = index_or_none(*webp, "source");
    }
    if (image < 0) {
      warnings_.add("textures without an image are not shown");
      return texture_of_[number] = kNone;
    }
    Texture texture{.image = use_image(image)};
    if (source.sampler >= 0) {
      const auto& sampler = document_.model.samplers[std::size_t(source.sampler)];
      texture.wrap_s = to_wrap(sampler.wrapS);
      texture.wrap_t = to_wrap(sampler.wrapT);
      if (sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST) texture.filter = Filter::nearest;
    }
    scene_.textures.push_back(texture);
    return texture_of_[number] = int(scene_.textures.size()) - 1;
  }

  const GltfDocument& document_;
  Scene& scene_;
  Warnings& warnings_;
  std::map<int, int> texture_of_;
  std::map<std::pair<std::string, int>, int> image_of_;
  std::vector<int> images_;
};

void read_extensions(const tinygltf::Material& source, TextureTable& textures, Material& material) {
  if (const auto* strength = find_extension(source.extensions, "KHR_materials_emissive_strength")) {
    material.emission *= float(number_or(*strength, "emissiveStrength", 1));
  }
  if (const auto* ior = find_extension(source.extensions, "KHR_materials_ior")) {
    material.ior = float(number_or(*ior, "ior", 1.5));
  }
  if (const auto* specular = find_extension(source.extensions, "KHR_materials_specular")) {
    material.specular = float(number_or(*specular, "specularFactor", 1));
    material.specular_color = to_rgb(numbers_or(*specular, "specularColorFactor", {1, 1, 1}));
    material.specular_texture = textures.use(*specular, "specularTexture");
    material.specular_color_texture = textures.use(*specular, "specularColorTexture");
  }
  material.unlit = find_extension(source.extensions, "KHR_materials_unlit") != nullptr;
}

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
  read_extensions(source, textures, material);
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
  const auto* use =
      find_extension(document.model.scenes[std::size_t(number)].extensions, "EXT_lights_environment");
  if (!use) return;
  const auto& all = document.model.extensions.at("EXT_lights_environment").Get("environments");
  const tinygltf::Value& source = all.Get(index_or_none(*use, "environment"));
  scene.environment.radiance = Rgb(float(number_or(source, "intensity", 1)));
  scene.environment.image = textures.use_image(index_or_none(source, "source"));
  scene.environment.rotation = to_rotation(text_or(source, "frontside", "+X"));
}

}  // namespace

int default_material(const GltfDocument& document, Scene& scene) {
  const std::size_t index = document.model.materials.size();
  if (scene.materials.size() == index) scene.materials.emplace_back().name = "default";
  return int(index);
}

void read_materials(const GltfDocument& document, Scene& scene, Warnings& warnings) {
  TextureTable textures(document, scene, warnings);
  for (const auto& source : document.model.materials)
    scene.materials.push_back(read_material(source, textures));
  read_environment(document, textures, scene);
  scene.images = read_images(document, textures.images());
}

}  // namespace parian
