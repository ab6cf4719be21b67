/// The seam to libparian_oiio, the shared library with all that knows OpenImageIO. Debian's OpenImageIO
/// brings 250 libraries, a third of a second and 126 MB of memory to each start of a program that is linked
/// with it; so it is opened when the first image is.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "images/image_cache.h"
#include "images/image_difference.h"
#include "images/image_io.h"

namespace parian {

/// What is behind an ImageCache, whose functions these are.
class TileCache {
 public:
  virtual ~TileCache() = default;
  virtual void limit(std::size_t bytes) = 0;
  virtual Image take(const Image& image) = 0;
  virtual ImageCacheStatistics statistics() const = 0;
  virtual std::string error() const = 0;
};

/// The functions of the same names in image_io.h and image_difference.h.
struct ImageLibrary {
  Image (*read_image)(std::span<const std::byte>, const std::string&);
  std::size_t (*decoded_bytes)(std::span<const std::byte>, const std::string&);
  Picture (*read_picture)(const std::string&);
  ColorEncoding (*read_color_encoding)(const std::string&);
  void (*write_exr)(const Picture&, const std::string&);
  void (*write_display_image)(const Picture&, const std::string&);
  std::vector<ChannelDifference> (*channel_differences)(const Picture&, const Picture&);
  void (*write_heat_map)(std::span<const float>, int, int, const std::string&);
  std::shared_ptr<TileCache> (*make_tile_cache)();
};

/// Opens the library at the first call, with as many threads as Parian has then. Throws std::runtime_error
/// where it cannot be opened.
const ImageLibrary& image_library();

/// What libparian_oiio exports, by the name kOpenImageLibrary. To be called once.
using OpenImageLibrary = const ImageLibrary*(int threads);
inline constexpr const char* kOpenImageLibrary = "parian_open_image_library";

}  // namespace parian
