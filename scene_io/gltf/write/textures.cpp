/// write_textures(): textures with their samplers, and images.
#include <algorithm>
#include <memory>
#include <utility>

#include "renderer/base/error.h"
#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/image_type.h"
#include "scene_io/gltf/write/member.h"
#include "scene_io/gltf/write/uri.h"

namespace parian {
namespace {

using nlohmann::json;

bool is_same(const Image& a, const Image& b) {
  const bool shared = a.source ? a.source == b.source : a.pixels.data() == b.pixels.data() && !b.source;
  return shared || a == b;
}

int to_gltf(Wrap wrap) {
  if (wrap == Wrap::clamp_to_edge) return 33071;
  return wrap == Wrap::mirrored_repeat ? 33648 : 10497;
}

int to_gltf(Filter filter) { return filter == Filter::nearest ? 9728 : 9729; }

class TextureWriter {
 public:
  explicit TextureWriter(Draft& draft) : draft_(draft) {}

  void run() {
    for (std::size_t i = 0; i < draft_.scene.images.size(); ++i) draft_.images.push_back(write_image(i));
    for (const Texture& texture : draft_.scene.textures) draft_.textures.push_back(write_texture(texture));
  }

 private:
  int write_image(std::size_t index) {
    const Image& image = draft_.scene.images[index];
    const Image* const before = draft_.before(&Scene::images, image.origin);
    if (before && is_same(image, *before)) {
      const GltfSource& source = *draft_.source_of(image.origin);
      return draft_.merged(image.origin, array::kImages,
                           std::size_t(source.images[std::size_t(image.origin.index)]));
    }
    if (!std::filesystem::is_regular_file(image.name)) {
      throw InputError(
          draft_.path.string(), fmt::format("/images/{}", index),
          fmt::format("cannot be written: expected an image of a scene or a file, '{}' is none", image.name));
    }
    json added;
    if (draft_.is_glb) {
      const auto bytes = std::make_shared<const std::vector<char>>(read_file(image.name));
      added["mimeType"] = image_type({bytes->data(), bytes->size()});
      added["bufferView"] =
          add_piece(draft_.root, draft_.data,
                    {bytes->size(), [bytes](FileWriter& file) { file.write(bytes->data(), bytes->size()); }});
    } else {
      added["uri"] = make_uri(image.name, draft_.folder);
    }
    json& images = need_array(draft_.root, array::kImages);
    images.push_back(std::move(added));
    if (is_webp_file(image.name)) webp_.push_back(int(images.size()) - 1);
    return int(images.size()) - 1;
  }

  /// A texture that is no longer that of the file gets a place of its own: what Parian does not read may use
  /// the old one.
  int write_texture(const Texture& texture) {
    const Texture* const before = draft_.before(&Scene::textures, texture.origin);
    json element = json::object();
    bool same_image = false;
    Texture was;
    if (before) {
      const GltfSource& source = *draft_.source_of(texture.origin);
      const int number = draft_.merged(texture.origin, array::kTextures,
                                       std::size_t(source.textures[std::size_t(texture.origin.index)]));
      const int image_before = draft_.merged(texture.origin, array::kImages,
                                             std::size_t(source.images[std::size_t(before->image)]));
      same_image = draft_.images[std::size_t(texture.image)] == image_before;
      was = *before;
      if (same_image && same_sampler(texture, was)) return number;
      element = (*find_array(draft_.root, array::kTextures))[std::size_t(number)];
    }
    if (!same_image) set_image(element, draft_.images[std::size_t(texture.image)]);
    if (!same_sampler(texture, was)) set_sampler(element, texture, was);
    json& textures = need_array(draft_.root, array::kTextures);
    textures.push_back(std::move(element));
    return int(textures.size()) - 1;
  }

  static bool same_sampler(const Texture& a, const Texture& b) {
    return a.wrap_s == b.wrap_s && a.wrap_t == b.wrap_t && a.filter == b.filter;
  }

  void set_image(json& texture, int image) {
    // Other encodings of the old image would be shown in place of the new one.
    for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif"})
      erase_extension(texture, name);
    texture.erase("source");
    if (std::ranges::find(webp_, image) != webp_.end())
      need_extension(texture, "EXT_texture_webp")["source"] = image;
    else
      texture["source"] = image;
  }

  void set_sampler(json& texture, const Texture& now, const Texture& before) {
    json& samplers = need_array(draft_.root, array::kSamplers);
    json sampler =
        texture.contains("sampler") ? samplers[texture["sampler"].get<std::size_t>()] : json::object();
    if (now.wrap_s != before.wrap_s) sampler["wrapS"] = to_gltf(now.wrap_s);
    if (now.wrap_t != before.wrap_t) sampler["wrapT"] = to_gltf(now.wrap_t);
    if (now.filter != before.filter) sampler["magFilter"] = to_gltf(now.filter);
    const auto known = std::ranges::find(samplers, sampler);
    texture["sampler"] = known - samplers.begin();
    if (known == samplers.end()) samplers.push_back(std::move(sampler));
  }

  Draft& draft_;
  std::vector<int> webp_;  // images added here that are of that type
};

}  // namespace

void write_textures(Draft& draft) { TextureWriter(draft).run(); }

}  // namespace parian
