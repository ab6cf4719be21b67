/// Image files, through OpenImageIO.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "renderer/base/image.h"
#include "renderer/scene/image.h"

namespace parian {

/// Throws std::runtime_error where what reads and writes images is not there, which otherwise the first image
/// would find: to be asked before long work that ends in one.
void require_image_library();

/// What the process will take for it, in bytes, with the first image: 0 once it is there. (Debian's
/// OpenImageIO with all that it needs; measured.)
std::size_t image_library_bytes();

/// Decodes an image at its own bit depth (8 and 16 bit integers, half, float); alpha unassociated, as glTF
/// stores it; at most 4 channels. `name` names it in messages. Throws InputError (unreadable, truncated,
/// unsupported, absurd size, NaN or Inf texels).
Image read_image(const std::string& path);
Image read_image(std::span<const std::byte> encoded, const std::string& name);

/// What read_image() would take for the texels, from the header alone. Throws InputError.
std::size_t decoded_bytes(std::span<const std::byte> encoded, const std::string& name);

/// Reads a picture (EXR or any other format) with all its channels and string metadata. Throws InputError.
Picture read_picture(const std::string& path);

/// How the colours of a file are written in numbers.
struct ColorEncoding {
  std::string transfer = "linear";  // or what they are encoded for: "sRGB", ...
  // x and y of red, green, blue and white.
  std::array<float, 8> chromaticities = kRec709;

  static constexpr std::array<float, 8> kRec709{0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
};

/// But for rounding in decimals such as .3127.
bool same_chromaticities(const ColorEncoding& a, const ColorEncoding& b);

/// From the header alone: EXR and Radiance HDR are linear and the rest sRGB where they do not say otherwise,
/// with the primaries and white of Rec.709. Throws InputError.
ColorEncoding read_color_encoding(const std::string& path);

/// Writes every channel as 32-bit float EXR (ZIP compression), metadata in the header, data in linear
/// Rec.709. The file appears whole or not at all (temporary file beside it, then rename). Throws InputError
/// naming the path.
void write_exr(const Picture& picture, const std::string& path);

/// Writes channels R, G, B, already display-referred in [0, 1], as 8-bit PNG or JPEG by extension, rounded to
/// nearest. Whole or not at all. Throws InputError (unwritable, or an extension that is neither).
void write_display_image(const Picture& picture, const std::string& path);

}  // namespace parian
