/// read_images(): decoding, through image_io.
#include <stdexcept>

#include "renderer/base/parallel.h"
#include "scene_io/gltf_file.h"
#include "scene_io/gltf_read.h"
#include "scene_io/image_io.h"

namespace parian {
namespace {

Image read_one(const GltfDocument& document, int number) {
  const auto& source = document.model.images[std::size_t(number)];
  const std::string where = fmt::format("/images/{}", number);
  const std::string name = source.name.empty() ? fmt::format("image {}", number) : source.name;
  try {
    if (source.bufferView >= 0) return read_image(document.view(source.bufferView), name);
    if (is_data_uri(source.uri)) {
      const SharedArray<std::byte> bytes = decode_data_uri(source.uri);
      return read_image(std::span<const std::byte>(bytes.data(), bytes.size()), name);
    }
    const std::filesystem::path path = resolve_uri(source.uri, document.folder);
    if (!std::filesystem::is_regular_file(path)) {
      document.fail(where + "/uri", fmt::format("expected a file, '{}' is not one", path.string()));
    }
    return read_image(path.string());
  } catch (const std::runtime_error& error) {
    // read_image() names the image; say as well where in the scene it is.
    const std::string_view what = error.what();
    if (what.starts_with(document.file + ": /images/")) throw;
    document.fail(where, what);
  }
}

}  // namespace

std::vector<Image> read_images(const GltfDocument& document, const std::vector<int>& used) {
  std::vector<Image> images(used.size());
  parallel_for(used.size(), 1, [&](std::size_t i) { images[i] = read_one(document, used[i]); });
  return images;
}

}  // namespace parian
