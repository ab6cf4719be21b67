/// Image files of some hundred bytes that claim to be far larger.
#pragma once

#include <cstdint>
#include <string>

namespace parian {

inline std::string big_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int i = bytes - 1; i >= 0; --i) text += char(value >> (8 * i));
  return text;
}

inline std::string png_chunk(const std::string& type, const std::string& content) {
  std::uint32_t crc = 0xffffffffu;
  for (const char c : type + content) {
    crc ^= std::uint8_t(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return big_endian(std::uint32_t(content.size()), 4) + type + content + big_endian(~crc, 4);
}

/// RGB, 8 bit; its pixels are one byte.
inline std::string png_bomb(std::uint32_t side, bool interlaced) {
  const std::string zlib_of_a_zero("\x78\x9c\x63\x00\x00\x00\x01\x00\x01", 9);
  return "\x89PNG\r\n\x1a\n" +
         png_chunk("IHDR", big_endian(side, 4) + big_endian(side, 4) + std::string("\x08\x02\x00\x00", 4) +
                               char(interlaced)) +
         png_chunk("IDAT", zlib_of_a_zero) + png_chunk("IEND", "");
}

/// Three channels; one scan of some zeros.
inline std::string jpeg_bomb(std::uint32_t side, bool progressive) {
  const auto segment = [](int marker, const std::string& content) {
    return std::string("\xff") + char(marker) + big_endian(std::uint32_t(content.size() + 2), 2) + content;
  };
  const auto huffman = [&](int table) {  // two codes of one bit would be one too many: one of two bits
    return segment(0xc4, char(table) + std::string("\0\1", 2) + std::string(15, '\0'));
  };
  const std::string components("\1\x11\0\2\x11\0\3\x11\0", 9), scan("\3\1\0\2\0\3\0\0", 8);
  return "\xff\xd8" + segment(0xdb, std::string(1, '\0') + std::string(64, '\1')) +
         segment(progressive ? 0xc2 : 0xc0,
                 "\x08" + big_endian(side, 2) + big_endian(side, 2) + "\x03" + components) +
         huffman(0x00) + huffman(0x10) + segment(0xda, scan + char(progressive ? 0 : 63) + '\0') +
         std::string(20, '\0') + "\xff\xd9";
}

inline std::string hdr_bomb(int side) {
  const std::string size = std::to_string(side);
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + size + " +X " + size + "\n" + std::string(20, '\0');
}

/// R, G, B as half; in scan lines, or in tiles of a side.
inline std::string exr_bomb(std::uint32_t side, std::uint32_t tile = 0) {
  const auto word = [](std::uint32_t value) {
    const std::string big = big_endian(value, 4);
    return std::string(big.rbegin(), big.rend());
  };
  const auto attribute = [&](const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + word(std::uint32_t(value.size())) + value;
  };
  std::string channels;
  for (const char c : {'B', 'G', 'R'})
    channels += std::string(1, c) + '\0' + word(1) + word(0) + word(1) + word(1);
  const std::string window = word(0) + word(0) + word(side - 1) + word(side - 1), zero(1, '\0');
  std::string file =
      word(0x01312f76) + word(tile ? 0x202 : 2) + attribute("channels", "chlist", channels + zero) +
      attribute("compression", "compression", "\3") + attribute("dataWindow", "box2i", window) +
      attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", zero) +
      attribute("pixelAspectRatio", "float", word(0x3f800000)) +
      attribute("screenWindowCenter", "v2f", word(0) + word(0)) +
      attribute("screenWindowWidth", "float", word(0x3f800000));
  if (tile) file += attribute("tiles", "tiledesc", word(tile) + word(tile) + zero);
  return file + zero + std::string(200, '\0');
}

}  // namespace parian
