#include "scene_io/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/file.h"
#include "renderer/base/parallel.h"
#include "scene_io/image_io_type.h"

namespace parian {
namespace {

using Bytes = std::span<const std::byte>;

// A side longer than this is a broken header, not a picture.
constexpr int kMaxSide = 65536;
// Nothing is allocated from a size that a header merely claims: beyond kPlainBytes the decoded picture may be
// at most kMaxExpansion times the file. Deflate, in PNG and EXR, expands at most 1032 times, JPEG less; and
// of both of these the libraries may hold the whole picture before they find that nothing is there
// (interlaced, progressive), so that little is plain for them.
constexpr std::size_t kPlainBytes = std::size_t(256) << 20;
constexpr std::size_t kPlainBytesOfWhole = std::size_t(16) << 20;
constexpr std::size_t kMaxExpansion = 1100;
// Rows decoded at a time, so that memory is touched only as far as the file really goes.
constexpr int kRowsAtOnce = 256;

constexpr std::string_view kFormats = "a PNG, JPEG, WebP, OpenEXR or Radiance HDR image";

// Images are decoded in parallel, each on one thread; only OpenEXR decodes one image on several, from one
// pool of the process that has as many as Parian's own.
void configure_oiio() {
  static std::once_flag once;
  std::call_once(once, [] {
    OIIO::attribute("threads", 1);
    OIIO::attribute("debug", 0);  // Debian's build would print remarks of its own
    OIIO::attribute("exr_threads", thread_count());
  });
}

bool starts_with(Bytes bytes, std::string_view magic, std::size_t at = 0) {
  return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
}

// OpenImageIO's name of the format, from the first bytes: names lie, above all in glTF files with a JPEG
// called .png.
std::string format_of(Bytes bytes, const std::string& name) {
  using namespace std::string_view_literals;
  if (starts_with(bytes, "\x89PNG\r\n\x1a\n"sv)) return "png";
  if (starts_with(bytes, "\xff\xd8\xff"sv)) return "jpeg";
  if (starts_with(bytes, "RIFF"sv) && starts_with(bytes, "WEBP"sv, 8)) return "webp";
  if (starts_with(bytes, "\x76\x2f\x31\x01"sv)) return "openexr";
  if (starts_with(bytes, "#?"sv)) return "hdr";
  if (starts_with(bytes, "\xabKTX 20\xbb"sv))
    throw InputError(name, "", fmt::format("KTX 2 is not supported; expected {}", kFormats));
  throw InputError(name, "", fmt::format("expected {}", kFormats));
}

struct JpegOutline {
  bool is_whole = false;
  unsigned width = 0, height = 0, channels = 0;
};

// What a JPEG claims, and whether it has its end. libjpeg fills what is missing with grey and only warns, and
// only once: not if stray bytes before a marker came first. So walk the segments to the end marker; inside
// entropy-coded data skip to the next marker that is neither stuffing (00) nor restart (D0-D7).
JpegOutline outline_of_jpeg(Bytes bytes) {
  JpegOutline outline;
  const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(bytes[i]); };
  std::size_t i = 2;
  while (i + 1 < bytes.size()) {
    if (at(i) != 0xff) {
      ++i;
      continue;
    }
    const unsigned marker = at(i + 1);
    if (marker == 0xd9) outline.is_whole = true;
    if (marker == 0xd9) return outline;
    if (marker == 0xff) {
      ++i;
    } else if (marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8)) {
      i += 2;
    } else {
      if (i + 3 >= bytes.size()) return outline;
      // A start of frame: C0 to CF, but for the tables C4 and CC and the reserved C8.
      const bool is_frame = (marker & 0xf0) == 0xc0 && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
      if (is_frame && i + 9 < bytes.size()) {
        outline.height = std::max(outline.height, at(i + 5) << 8 | at(i + 6));
        outline.width = std::max(outline.width, at(i + 7) << 8 | at(i + 8));
        outline.channels = std::max(outline.channels, at(i + 9));
      }
      i += 2 + (at(i + 2) << 8 | at(i + 3));
    }
  }
  return outline;
}

std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table;
  for (std::uint32_t i = 0; i < 256; ++i) {
    table[i] = i;
    for (int bit = 0; bit < 8; ++bit) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xedb88320u : 0);
  }
  return table;
}

// What is wrong with the chunks of a PNG file, or "". OpenImageIO would let libpng print its complaint to
// stderr, and takes a file without its last chunks; so length and checksum of each chunk that matters are
// checked before (PNG specification, section 5).
std::string png_problem(Bytes bytes) {
  static const std::array<std::uint32_t, 256> table = make_crc_table();
  const auto word = [&](std::size_t i) {
    const auto at = [&](std::size_t k) { return std::to_integer<std::uint32_t>(bytes[i + k]); };
    return at(0) << 24 | at(1) << 16 | at(2) << 8 | at(3);
  };
  std::size_t i = 8;
  while (bytes.size() >= i + 12) {
    const std::size_t length = word(i);
    if (bytes.size() - i - 12 < length) break;
    const std::string_view type(reinterpret_cast<const char*>(bytes.data()) + i + 4, 4);
    const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
    if (!std::ranges::all_of(type, is_letter)) return fmt::format("no chunk type at byte {}", i + 4);
    const bool critical = type[0] <= 'Z';
    std::uint32_t crc = 0xffffffffu;
    if (critical)
      for (const std::byte b : bytes.subspan(i + 4, length + 4))
        crc = crc >> 8 ^ table[(crc ^ std::to_integer<std::uint32_t>(b)) & 0xff];
    if (critical && ~crc != word(i + 8 + length))
      return fmt::format("wrong checksum of the chunk at byte {}", i);
    if (type == "IEND") return "";
    i += 12 + length;
  }
  return "truncated: the PNG has no end";
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

// An open image and the memory it is read from.
struct Reader {
  std::string name;
  std::size_t file_size;
  std::size_t plain_bytes = kPlainBytes;
  OIIO::Filesystem::IOMemReader memory;
  std::unique_ptr<OIIO::ImageInput> input;
  OIIO::ImageSpec spec;
  bool is_exr = false, is_webp = false, is_scene_referred = false;

  Reader(Bytes bytes, std::string file)
      : name(std::move(file)), file_size(bytes.size()), memory(bytes.data(), bytes.size()) {
    const std::string format = format_of(bytes, name);
    is_exr = format == "openexr";
    is_scene_referred = is_exr || format == "hdr";
    is_webp = format == "webp";
    if (format == "jpeg" || format == "png") plain_bytes = kPlainBytesOfWhole;
    if (format == "jpeg") {
      const JpegOutline outline = outline_of_jpeg(bytes);
      if (!outline.is_whole) throw InputError(name, "", "truncated: the JPEG has no end");
      // libjpeg decodes all of a progressive one when it is opened.
      check_claim(outline.width, outline.height, outline.channels, 1);
    }
    if (format == "png")
      if (const std::string problem = png_problem(bytes); !problem.empty())
        throw InputError(name, "", problem);
    configure_oiio();
    input = OIIO::ImageInput::create(format);
    if (!input)
      throw InputError(name, "", fmt::format("no reader for {}: {}", format, first_line(OIIO::geterror())));
    input->threads(1);
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    OIIO::Filesystem::IOProxy* proxy = &memory;
    config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
    if (!input->open(name, spec, config)) fail(input->geterror());
    if (spec.width <= 0 || spec.height <= 0 || spec.width > kMaxSide || spec.height > kMaxSide ||
        spec.nchannels <= 0)
      throw InputError(
          name, "",
          fmt::format("{} x {} pixels; expected 1 to {} each way", spec.width, spec.height, kMaxSide));
    if (spec.deep || spec.depth > 1)
      throw InputError(name, "", "expected a flat image, not a deep one or a volume");
    if (is_exr && (spec.width != spec.full_width || spec.height != spec.full_height ||
                   spec.x != spec.full_x || spec.y != spec.full_y))
      throw InputError(name, "", "the data window is not the display window; expected a whole picture");
  }

  // With the library's own words, in one line.
  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(
        name, "",
        fmt::format("broken or truncated: {}", text.empty() ? "cannot be decoded" : first_line(text)));
  }

  std::size_t check_claim(std::size_t width, std::size_t height, std::size_t channels,
                          std::size_t sample_bytes) const {
    const std::size_t bytes = width * height * channels * sample_bytes;
    if (bytes > plain_bytes && bytes / kMaxExpansion > file_size)
      throw InputError(name, "",
                       fmt::format("{} x {} x {} claimed by a file of {} bytes: more than it can hold", width,
                                   height, channels, file_size));
    return bytes;
  }

  std::size_t checked_bytes(int channels, std::size_t sample_bytes) const {
    return check_claim(std::size_t(spec.width), std::size_t(spec.height), std::size_t(channels),
                       sample_bytes);
  }

  // Rows [begin, end) of the channels [first, last); tiled files can only be asked for the whole.
  void read_rows(int begin, int end, int first, int last, OIIO::TypeDesc type, void* out) {
    const bool ok = spec.tile_width ? input->read_image(0, 0, first, last, type, out)
                                    : input->read_scanlines(0, 0, spec.y + begin, spec.y + end, 0, first,
                                                            last, type, out);
    if (ok && !input->has_error()) return;
    const std::string text = input->geterror();
    // What many a JPEG in the world has, and what harms no pixel.
    if (ok && text.find("extraneous bytes before marker") != std::string::npos) return;
    fail(text);
  }
};

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

std::string encode(const char* format, const OIIO::ImageSpec& spec, const void* pixels,
                   const std::string& path) {
  configure_oiio();
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

Image read_image(const std::string& path) {
  const std::vector<char> bytes = read_file(path);
  return read_image(std::as_bytes(std::span(bytes)), path);
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

bool same_chromaticities(const ColorEncoding& a, const ColorEncoding& b) {
  const auto near = [](float x, float y) { return std::abs(x - y) < 1e-4f; };
  return std::ranges::equal(a.chromaticities, b.chromaticities, near);
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

}  // namespace parian
