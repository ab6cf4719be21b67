#include "scene_io/gltf/file/file.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/parallel.h"

namespace parian {
namespace {

// The .glb container is little-endian, as is every machine Parian builds for.
std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t offset) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + offset, sizeof(value));
  return value;
}

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942;   // "BIN"
constexpr std::size_t kReadAtOnce = std::size_t(4) << 20;

constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;

GltfChunks split_glb(std::span<const std::byte> bytes, const std::string& file) {
  if (bytes.size() < kHeaderBytes) throw InputError(file, "byte 4", "expected a .glb header of 12 bytes");
  if (read_u32(bytes, 4) != 2) {
    throw InputError(file, "byte 4", fmt::format("expected .glb version 2, found {}", read_u32(bytes, 4)));
  }
  const std::size_t length = read_u32(bytes, 8);
  if (length > bytes.size()) {
    throw InputError(
        file, "byte 8",
        fmt::format("expected {} bytes, as the header says; the file has {}", length, bytes.size()));
  }
  GltfChunks chunks;
  std::size_t offset = kHeaderBytes;
  for (int i = 0; i == 0 || (i == 1 && offset < length); ++i) {
    const std::string where = fmt::format("byte {}", offset);
    if (length < offset + kChunkHeaderBytes)
      throw InputError(file, where, "expected a chunk header of 8 bytes");
    const std::size_t size = read_u32(bytes, offset);
    const std::uint32_t type = read_u32(bytes, offset + 4);
    offset += kChunkHeaderBytes;
    if (size > length - offset) {
      throw InputError(file, where,
                       fmt::format("expected a chunk of at most {} bytes, found {}", length - offset, size));
    }
    const auto content = bytes.subspan(offset, size);
    if (i == 0) {
      if (type != kJsonChunk) throw InputError(file, where, "expected the first chunk to be JSON");
      chunks.json = {reinterpret_cast<const char*>(content.data()), content.size()};
    } else if (type == kBinChunk) {
      chunks.binary = content;
    }
    offset += size;
  }
  return chunks;
}

// The value of one base64 digit, or -1.
int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decode_percent(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool escaped =
        uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
    text += escaped ? char(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2])) : uri[i];
    if (escaped) i += 2;
  }
  return text;
}

}  // namespace

std::shared_ptr<PageBuffer> read_asset_file(const std::filesystem::path& path) {
  std::error_code error;
  // Also keeps out pipes and devices, which have no end or no size.
  if (!std::filesystem::is_regular_file(path, error)) {
    throw std::runtime_error(fmt::format("expected a file, '{}' is not one", path.string()));
  }
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!stream) {
    throw std::runtime_error(
        fmt::format("expected to be able to read '{}': {}", path.string(), std::strerror(errno)));
  }
  const auto size = std::filesystem::file_size(path, error);
  if (error) throw std::runtime_error(fmt::format("expected to be able to read '{}'", path.string()));
  require_memory(size, fmt::format("reading '{}'", path.string()));
  const auto bytes = std::make_shared<PageBuffer>(size);
  const int descriptor = fileno(stream.get());
  parallel_for((size + kReadAtOnce - 1) / kReadAtOnce, 1, [&](std::size_t i) {
    const std::size_t end = std::min(size, (i + 1) * kReadAtOnce);
    for (std::size_t at = i * kReadAtOnce; at < end;) {
      const ssize_t got = pread(descriptor, bytes->data() + at, end - at, off_t(at));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0)
        throw std::runtime_error(fmt::format("expected to read {} bytes of '{}'", size, path.string()));
      at += std::size_t(got);
    }
  });
  return bytes;
}

GltfChunks split_gltf(std::span<const std::byte> bytes, const std::string& file) {
  if (bytes.size() >= 4 && read_u32(bytes, 0) == kGlbMagic) return split_glb(bytes, file);
  return {.json = {reinterpret_cast<const char*>(bytes.data()), bytes.size()}, .binary = {}};
}

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

SharedArray<std::byte> decode_data_uri(std::string_view uri) {
  constexpr std::string_view marker = ";base64,";
  const std::size_t comma = uri.find(',');
  const std::size_t start = comma == std::string_view::npos ? 0 : comma + 1;
  if (!uri.substr(0, start).ends_with(marker)) throw std::runtime_error("expected a base64 data URI");
  std::string_view digits = uri.substr(start);
  while (digits.ends_with('=')) digits.remove_suffix(1);
  if (digits.size() % 4 == 1) throw std::runtime_error("expected a whole number of base64 bytes");

  std::vector<std::byte> bytes;
  bytes.reserve(digits.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    const int digit = base64_digit(digits[i]);
    if (digit < 0) throw std::runtime_error(fmt::format("expected base64, character {} is not", start + i));
    bits = bits << 6 | std::uint32_t(digit);
    // Digit 0 of four only carries bits; digits 1, 2, 3 each complete a byte, with 4, 2, 0 bits left over.
    if (i % 4 != 0) bytes.push_back(std::byte(bits >> (6 - 2 * (i % 4)) & 0xFF));
  }
  return bytes;
}

std::filesystem::path resolve_uri(std::string_view uri, const std::filesystem::path& folder) {
  if (uri.find("://") != std::string_view::npos) {
    throw std::runtime_error(
        fmt::format("expected a relative path or a data URI, found '{}'", uri.substr(0, 80)));
  }
  const std::string text = decode_percent(uri);
  if (text.empty() || text.find('\0') != std::string::npos) {
    throw std::runtime_error("expected a relative path or a data URI");
  }
  return folder / text;
}

}  // namespace parian
