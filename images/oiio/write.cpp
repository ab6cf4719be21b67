#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "images/oiio/library.h"
#include "images/oiio/reader.h"
#include "renderer/base/error.h"
#include "renderer/base/file.h"

namespace parian::oiio {
namespace {

std::string encode(const char* format, const OIIO::ImageSpec& spec, const void* pixels,
                   const std::string& path) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  const auto output = OIIO::ImageOutput::create(format, &memory);
  if (!output) throw InputError(path, "", fmt::format("no writer for {}", format));
  output->threads(1);
  if (!output->open(path, spec) || !output->write_image(spec.format, pixels) || !output->close())
    throw InputError(path, "", fmt::format("cannot be encoded: {}", first_line(output->geterror())));
  return {bytes.begin(), bytes.end()};
}

int channel_index(const Picture& picture, std::string_view name, const std::string& path) {
  const auto found = std::find(picture.channels.begin(), picture.channels.end(), name);
  if (found == picture.channels.end())
    throw InputError(path, "", fmt::format("the picture has no channel {}", name));
  return int(found - picture.channels.begin());
}

}  // namespace

void write_exr(const Picture& picture, const std::string& path) {
  OIIO::ImageSpec spec(picture.width, picture.height, int(picture.channels.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = picture.channels;
  spec.attribute("Software", "Parian");
  for (const auto& [key, value] : picture.metadata) spec.attribute(key, value);
  spec.attribute("compression", "zip");
  // Rec.709 primaries and white, which is what a file without this attribute means too.
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), ColorEncoding::kRec709.data());
  // The writer adds the time of day where this attribute is not there, and skips one of a wrong type: the
  // same picture has to give the same bytes.
  spec.attribute("DateTime", 0);
  write_file(path, encode("openexr", spec, picture.pixels.data(), path));
}

void write_display_image(const Picture& picture, const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  const bool jpeg = extension == ".jpg" || extension == ".jpeg";
  if (!jpeg && extension != ".png")
    throw InputError(path, "", "expected a name that ends in .png, .jpg or .jpeg");
  const int index[3] = {channel_index(picture, "R", path), channel_index(picture, "G", path),
                        channel_index(picture, "B", path)};
  const std::size_t count = std::size_t(picture.width) * picture.height;
  std::vector<std::uint8_t> pixels(3 * count);
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = picture.pixels[i * picture.channels.size() + index[c]];
      // A comparison with NaN is false, so that NaN becomes 0.
      pixels[3 * i + c] = value > 0 ? std::uint8_t(std::min(value, 1.0f) * 255 + 0.5f) : 0;
    }
  OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (jpeg) {
    spec.attribute("Compression", "jpeg:95");
    spec.attribute("jpeg:subsampling", "4:4:4");
  }
  write_file(path, encode(jpeg ? "jpeg" : "png", spec, pixels.data(), path));
}

}  // namespace parian::oiio
