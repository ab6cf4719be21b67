#include "images/oiio/encoded.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "renderer/base/error.h"

namespace parian::oiio {
namespace {

using Bytes = std::span<const std::byte>;

constexpr std::string_view kFormats = "a PNG, JPEG, WebP, OpenEXR or Radiance HDR image";

bool starts_with(Bytes bytes, std::string_view magic, std::size_t at = 0) {
  return bytes.size() >= at + magic.size() && std::memcmp(bytes.data() + at, magic.data(), magic.size()) == 0;
}

std::array<std::uint32_t, 256> make_crc_table() {
  std::array<std::uint32_t, 256> table;
  for (std::uint32_t i = 0; i < 256; ++i) {
    table[i] = i;
    for (int bit = 0; bit < 8; ++bit) table[i] = table[i] >> 1 ^ (table[i] & 1 ? 0xedb88320u : 0);
  }
  return table;
}

}  // namespace

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

// Walks the segments to the end marker; inside entropy-coded data skips to the next marker that is neither
// stuffing (00) nor restart (D0-D7).
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

}  // namespace parian::oiio
