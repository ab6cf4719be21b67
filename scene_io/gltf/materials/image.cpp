/// read_images(): decoding, through image_io.
#include <stdexcept>

#include "images/image_io.h"
#include "images/image_memory.h"
#include "renderer/base/file.h"
#include "renderer/base/parallel.h"
#include "scene_io/gltf/file/file.h"
#include "scene_io/gltf/read.h"

namespace parian {
namespace {

using Bytes = std::span<const std::byte>;

/// read(bytes, name) of the encoded image, which is not kept.
template <class Read>
auto read_one(const GltfDocument& document, int number, const Read& read) {
  const auto& source = document.model.images[std::size_t(number)];
  const std::string where = fmt::format("/images/{}", number);
  const std::string name = source.name.empty() ? fmt::format("image {}", number) : source.name;
  try {
    if (source.bufferView >= 0) return read(document.view(source.bufferView), name);
    if (is_data_uri(source.uri)) {
      const SharedArray<std::byte> bytes = decode_data_uri(source.uri);
      return read(Bytes(bytes.data(), bytes.size()), name);
    }
    const std::filesystem::path path = resolve_uri(source.uri, document.folder);
    if (!std::filesystem::is_regular_file(path)) {
      document.fail(where + "/uri", fmt::format("expected a file, '{}' is not one", path.string()));
    }
    const std::vector<char> bytes = read_file(path.string());
    return read(std::as_bytes(std::span(bytes)), path.string());
  } catch (const std::runtime_error& error) {
    // What reads it names the image; say as well where in the scene it is.
    const std::string_view what = error.what();
    if (what.starts_with(document.file + ": /images/")) throw;
    document.fail(where, what);
  }
}

Image decode(const GltfDocument& document, int number) {
  return read_one(document, number,
                  [](Bytes bytes, const std::string& name) { return read_image(bytes, name); });
}

}  // namespace

std::vector<Image> read_images(const GltfDocument& document, const std::vector<int>& used, int environment,
                               const LoadSettings& settings) {
  std::vector<Image> images(used.size());
  ImageMemory* memory = settings.image_memory;
  if (!memory) {
    parallel_for(used.size(), 1, [&](std::size_t i) { images[i] = decode(document, used[i]); });
    return images;
  }
  std::vector<std::size_t> bytes(used.size());
  parallel_for(used.size(), 1, [&](std::size_t i) { bytes[i] = read_one(document, used[i], decoded_bytes); });
  if (environment != kNone) {
    memory->keep(std::exchange(bytes[std::size_t(environment)], 0), document.file);
  }
  const ImagePlan plan = memory->plan(bytes, !settings.more_scenes);
  const auto for_each = [&](const std::vector<std::size_t>& numbers, const auto& make) {
    parallel_for(numbers.size(), 1,
                 [&](std::size_t i) { images[numbers[i]] = make(decode(document, used[numbers[i]])); });
  };
  for_each(plan.in_memory, [](Image image) { return image; });
  for (const auto& group : plan.cached) {
    for_each(group, [&](const Image& image) { return memory->move_to_cache(image); });
  }
  return images;
}

}  // namespace parian
