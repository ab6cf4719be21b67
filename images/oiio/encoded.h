/// What an encoded image says of itself, before a decoder of another library sees it.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace parian::oiio {

/// OpenImageIO's name of the format, from the first bytes: names lie, above all in glTF files with a JPEG
/// called .png. Throws InputError, which calls the image `name`.
std::string format_of(std::span<const std::byte> encoded, const std::string& name);

struct JpegOutline {
  bool is_whole = false;
  unsigned width = 0, height = 0, channels = 0;
};

/// What a JPEG claims, and whether it has its end. libjpeg fills what is missing with grey and only warns,
/// and only once: not if stray bytes before a marker came first.
JpegOutline outline_of_jpeg(std::span<const std::byte> encoded);

/// What is wrong with the chunks of a PNG file, or "". OpenImageIO would let libpng print its complaint to
/// stderr, and takes a file without its last chunks; so length and checksum of each chunk that matters are
/// checked before (PNG specification, section 5).
std::string png_problem(std::span<const std::byte> encoded);

}  // namespace parian::oiio
