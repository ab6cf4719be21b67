#include "scene_io/gltf/materials/texture_table.h"

#include <array>
#include <cmath>
#include <filesystem>

#include "scene_io/gltf/file/file.h"

namespace parian {
namespace {

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

}  // namespace

int TextureTable::use_image(int image) {
  const auto& source = document_.model.images[std::size_t(image)];
  // However a file's path is written: with ./ before it, or not.
  const std::string from =
      is_data_uri(source.uri) ? source.uri : std::filesystem::path(source.uri).lexically_normal().string();
  const auto [found, is_new] = image_of_.try_emplace({from, source.bufferView}, int(images_.size()));
  if (is_new) images_.push_back(image);
  return found->second;
}

TextureRef TextureTable::use(int texture, int uv_set, const tinygltf::ExtensionMap& extensions) {
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

TextureRef TextureTable::use(const tinygltf::Value& extension, const char* key) {
  if (!extension.Has(key)) return {};
  const tinygltf::Value& info = extension.Get(key);
  tinygltf::ExtensionMap extensions;
  if (info.Has("extensions")) extensions = info.Get("extensions").Get<tinygltf::Value::Object>();
  return use(index_or_none(info, "index"), int(number_or(info, "texCoord", 0)), extensions);
}

int TextureTable::use_texture(int number) {
  if (const auto known = texture_of_.find(number); known != texture_of_.end()) return known->second;
  const auto& source = document_.model.textures[std::size_t(number)];
  int image = source.source;
  if (const auto* webp = find_extension(source.extensions, "EXT_texture_webp"); webp && webp->Has("source")) {
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
  textures_.push_back(number);
  return texture_of_[number] = int(scene_.textures.size()) - 1;
}

}  // namespace parian
