/// Images beyond the memory there is: in a temporary file, a part of it in OpenImageIO's cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include "renderer/scene/image.h"

namespace parian {

struct ImageCacheStatistics {
  std::size_t file_bytes = 0;    // of the temporary file
  std::size_t peak_bytes = 0;    // the most that tiles took in memory
  std::uint64_t tile_reads = 0;  // from the file: the cache's misses
};

class TileCache;

class ImageCache {
 public:
  static constexpr std::size_t kLeastBytes = std::size_t(12) << 20;  // OpenImageIO takes 10 at least

  /// Throws InputError where no temporary file can be made.
  ImageCache();

  /// What tiles may take, at least kLeastBytes; 256 MiB at first. Not while texels are looked up.
  void limit(std::size_t bytes);

  /// The same image with its texels in the file, readable for as long as it or a copy of it is there. For any
  /// thread. Throws InputError where the disk is full.
  Image take(const Image& image);

  ImageCacheStatistics statistics() const;

  /// What went wrong when texels were read, or "": from then on some were black.
  std::string error() const;

 private:
  std::shared_ptr<TileCache> tiles_;
};

}  // namespace parian
