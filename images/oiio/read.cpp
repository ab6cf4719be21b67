#include <algorithm>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "images/oiio/library.h"
#include "images/oiio/oiio_type.h"
#include "images/oiio/reader.h"
#include "renderer/base/error.h"
#include "renderer/base/file.h"

namespace parian::oiio {
namespace {

using Bytes = std::span<const std::byte>;

// Rows decoded at a time, so that memory is touched only as far as the file really goes.
constexpr int kRowsAtOnce = 256;

// The first and one-past-last channel that a texture takes: grey, grey and alpha, colour, colour and alpha.
// Of an EXR file only the colour: its alpha is coverage, with which the colour is multiplied already, and a
// texture or an environment in EXR is meant to be whole.
std::pair<int, int> texture_channels(const Reader& reader) {
  const OIIO::ImageSpec& spec = reader.spec;
  if (!reader.is_exr) {
    if (spec.nchannels > 4)
      throw InputError(reader.name, "", fmt::format("{} channels; expected at most 4", spec.nchannels));
    return {0, spec.nchannels};
  }
  const int red = spec.channelindex("R"), grey = spec.channelindex("Y");
  if (red >= 0 && spec.channelindex("G") == red + 1 && spec.channelindex("B") == red + 2)
    return {red, red + 3};
  if (grey >= 0) return {grey, grey + 1};
  throw InputError(reader.name, "", "expected channels R, G, B, or Y alone");
}

// The type that holds the samples of a texture without loss, of those that textures have.
PixelType texture_type(const Reader& reader, int first, int last) {
  PixelType type = PixelType::u8;
  for (int c = first; c < last; ++c) {
    const OIIO::TypeDesc format = reader.spec.channelformat(c);
    const PixelType channel = format == OIIO::TypeDesc::UINT8    ? PixelType::u8
                              : format == OIIO::TypeDesc::UINT16 ? PixelType::u16
                              : format == OIIO::TypeDesc::HALF   ? PixelType::f16
                                                                 : PixelType::f32;
    type = c == first || channel == type ? channel : PixelType::f32;
  }
  return type;
}

// Exponent bits all set is what Inf and NaN are made of, in half and in float.
void check_finite(const Image& image, const std::string& name) {
  const auto check = [&](auto exponent) {
    using Word = decltype(exponent);
    const auto* words = reinterpret_cast<const Word*>(image.pixels.data());
    const std::size_t count = image.pixels.size() / sizeof(Word);
    for (std::size_t i = 0; i < count; ++i) {
      if ((words[i] & exponent) != exponent) continue;
      const std::size_t pixel = i / image.channels;
      throw InputError(name, fmt::format("pixel ({}, {})", pixel % image.width, pixel / image.width),
                       "NaN or Inf; expected finite values");
    }
  };
  if (image.type == PixelType::f16) check(std::uint16_t(0x7c00));
  if (image.type == PixelType::f32) check(std::uint32_t(0x7f800000));
}

// OpenImageIO multiplies the colour of WebP by its alpha whatever it is asked for; this undoes it, as far as
// 8 bits allow.
void unpremultiply_webp(std::byte* pixels, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const unsigned alpha = std::to_integer<unsigned>(pixels[4 * i + 3]);
    if (alpha == 0 || alpha == 255) continue;
    for (int c = 0; c < 3; ++c) {
      std::byte& value = pixels[4 * i + c];
      value = std::byte(std::min(255u, (std::to_integer<unsigned>(value) * 255 + alpha / 2) / alpha));
    }
  }
}

}  // namespace

std::size_t decoded_bytes(Bytes encoded, const std::string& name) {
  const Reader reader(encoded, name);
  const auto [first, last] = texture_channels(reader);
  return reader.checked_bytes(last - first, oiio_type(texture_type(reader, first, last)).size());
}

Image read_image(Bytes encoded, const std::string& name) try {
  Reader reader(encoded, name);
  const auto [first, last] = texture_channels(reader);
  Image image;
  image.name = name;
  image.width = reader.spec.width;
  image.height = reader.spec.height;
  image.channels = last - first;
  image.type = texture_type(reader, first, last);
  const OIIO::TypeDesc type = oiio_type(image.type);
  const std::size_t size = reader.checked_bytes(image.channels, type.size());
  // Not initialised, so that a page that no row reaches is never touched.
  auto pixels = std::make_shared_for_overwrite<std::byte[]>(size);
  const std::size_t row = size / image.height;
  const int step = reader.spec.tile_width ? image.height : kRowsAtOnce;
  for (int y = 0; y < image.height; y += step)
    reader.read_rows(y, std::min(image.height, y + step), first, last, type, pixels.get() + row * y);
  if (reader.is_webp && image.channels == 4)
    unpremultiply_webp(pixels.get(), std::size_t(image.width) * image.height);
  std::byte* data = pixels.get();
  image.pixels = {std::move(pixels), data, size};
  check_finite(image, name);
  return image;
} catch (const std::bad_alloc&) {
  throw InputError(name, "", "too large for the memory there is");
}

Picture read_picture(const std::string& path) try {
  const std::vector<char> bytes = read_file(path);
  Reader reader(std::as_bytes(std::span(bytes)), path);
  Picture picture;
  picture.width = reader.spec.width;
  picture.height = reader.spec.height;
  picture.channels = reader.spec.channelnames;
  const int channels = reader.spec.nchannels;
  const std::size_t size = reader.checked_bytes(channels, sizeof(float)) / sizeof(float);
  picture.pixels.reserve(size);
  const std::size_t row = std::size_t(picture.width) * channels;
  const int step = reader.spec.tile_width ? picture.height : kRowsAtOnce;
  for (int y = 0; y < picture.height; y += step) {
    const int end = std::min(picture.height, y + step);
    picture.pixels.resize(row * end);
    reader.read_rows(y, end, 0, channels, OIIO::TypeDesc::FLOAT, picture.pixels.data() + row * y);
  }
  for (const OIIO::ParamValue& attribute : reader.spec.extra_attribs) {
    const std::string key = attribute.name().string();
    // What describes the file's encoding is the library's, not the picture's.
    const bool encoding = key == "compression" || key.starts_with("oiio:") || key.starts_with("openexr:");
    if (attribute.type() == OIIO::TypeString && !encoding) picture.metadata[key] = attribute.get_string();
  }
  return picture;
} catch (const std::bad_alloc&) {
  throw InputError(path, "", "too large for the memory there is");
}

ColorEncoding read_color_encoding(const std::string& path) {
  const std::vector<char> bytes = read_file(path);
  const Reader reader(std::as_bytes(std::span(bytes)), path);
  ColorEncoding encoding;
  // Names of linear spaces are "Linear", "scene_linear", "lin_rec709" and the like, by version.
  const std::string space =
      reader.spec.get_string_attribute("oiio:ColorSpace", reader.is_scene_referred ? "Linear" : "sRGB");
  const bool linear = space.starts_with("lin") || space.starts_with("Lin") || space == "scene_linear";
  if (!linear) encoding.transfer = space;
  reader.spec.getattribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8),
                           encoding.chromaticities.data());
  return encoding;
}

}  // namespace parian::oiio
