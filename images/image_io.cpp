#include "images/image_io.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "images/image_library.h"
#include "renderer/base/file.h"

namespace parian {

Image read_image(std::span<const std::byte> encoded, const std::string& name) {
  return image_library().read_image(encoded, name);
}

Image read_image(const std::string& path) {
  const std::vector<char> bytes = read_file(path);
  return read_image(std::as_bytes(std::span(bytes)), path);
}

std::size_t decoded_bytes(std::span<const std::byte> encoded, const std::string& name) {
  return image_library().decoded_bytes(encoded, name);
}

Picture read_picture(const std::string& path) { return image_library().read_picture(path); }

ColorEncoding read_color_encoding(const std::string& path) {
  return image_library().read_color_encoding(path);
}

bool same_chromaticities(const ColorEncoding& a, const ColorEncoding& b) {
  const auto near = [](float x, float y) { return std::abs(x - y) < 1e-4f; };
  return std::ranges::equal(a.chromaticities, b.chromaticities, near);
}

void write_exr(const Picture& picture, const std::string& path) { image_library().write_exr(picture, path); }

void write_display_image(const Picture& picture, const std::string& path) {
  image_library().write_display_image(picture, path);
}

}  // namespace parian
