/// Decoded images, as textures and environments have them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "renderer/base/shared_array.h"

namespace parian {

class TexelSource;

enum class PixelType : std::uint8_t { u8, u16, f16, f32 };

/// A decoded picture at its file's own bit depth; 1 to 4 channels, interleaved, row 0 at the top (v = 0).
struct Image {
  std::string name;  // for messages: its file name, or image N of a file
  int width = 0, height = 0, channels = 0;
  PixelType type = PixelType::u8;
  SharedArray<std::byte> pixels;
  std::shared_ptr<const TexelSource> source = nullptr;  // where the texels are if `pixels` is empty
  /// Of the same name, size and type, and bitwise equal texels, wherever they are.
  bool operator==(const Image& other) const;
};

/// What one pixel takes, and all of them.
std::size_t pixel_bytes(const Image& image);
std::size_t image_bytes(const Image& image);

}  // namespace parian
