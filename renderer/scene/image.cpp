#include "renderer/scene/image.h"

#include <algorithm>
#include <span>
#include <vector>

#include "renderer/scene/texel_source.h"

namespace parian {
namespace {

/// Row y of the image; `storage` holds it where it is not in memory.
std::span<const std::byte> row_of(const Image& image, int y, std::vector<std::byte>& storage) {
  const std::size_t bytes = image.width * pixel_bytes(image);
  if (!image.source) return {image.pixels.data() + bytes * y, bytes};
  std::vector<Vec2i> places;
  for (int x = 0; x < image.width; ++x) places.emplace_back(x, y);
  storage.resize(bytes);
  image.source->fetch(places, storage.data());
  return storage;
}

}  // namespace

std::size_t pixel_bytes(const Image& image) {
  const int bytes = image.type == PixelType::u8 ? 1 : image.type == PixelType::f32 ? 4 : 2;
  return std::size_t(image.channels) * bytes;
}

std::size_t image_bytes(const Image& image) {
  return std::size_t(image.width) * image.height * pixel_bytes(image);
}

bool Image::operator==(const Image& other) const {
  if (width != other.width || height != other.height || channels != other.channels || type != other.type)
    return false;
  if (source == other.source) return pixels == other.pixels;
  std::vector<std::byte> a, b;
  for (int y = 0; y < height; ++y)
    if (!std::ranges::equal(row_of(*this, y, a), row_of(other, y, b))) return false;
  return true;
}

}  // namespace parian
