/// Decoded images, as textures and environments have them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "renderer/base/shared_array.h"

namespace parian {

class TexelSource;

/// Where a thing in a scene came from: its number among those of its kind in the scene that one loaded file
/// gave. A copy keeps it, and with it what the file says of the thing that Parian has no use for. It is not
/// part of what the thing is: two things differ by their values alone.
struct Origin {
  int file = -1;   // number of the file; -1: made here
  int index = -1;  // in the scene as loaded from it
  bool operator==(const Origin&) const { return true; }
};

enum class PixelType : std::uint8_t { u8, u16, f16, f32 };

/// A decoded picture at its file's own bit depth; 1 to 4 channels, interleaved, row 0 at the top (v = 0).
struct Image {
  std::string name;  // for messages: the path of its file, or its name or number in a scene's
  int width = 0, height = 0, channels = 0;
  PixelType type = PixelType::u8;
  SharedArray<std::byte> pixels;
  std::shared_ptr<const TexelSource> source = nullptr;  // where the texels are if `pixels` is empty
  Origin origin = {};
  /// Of the same size and type, and bitwise equal texels, wherever they are and whatever they are called.
  bool operator==(const Image& other) const;
};

/// What one pixel takes, and all of them.
std::size_t pixel_bytes(const Image& image);
std::size_t image_bytes(const Image& image);

}  // namespace parian
