/// How much memory images may take.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "images/image_cache.h"

namespace parian {

/// Images by their numbers.
struct ImagePlan {
  std::vector<std::size_t> in_memory;
  /// For the cache, in groups that are decoded together: each fits into memory beside all others, or is of
  /// one.
  std::vector<std::vector<std::size_t>> cached;
};

struct ImageMemoryStatistics {
  std::size_t memory_bytes = 0;  // texels in memory, without the cache
  std::size_t cache_bytes = 0;   // what the cache may take
  ImageCacheStatistics cache;
};

/// A cap for the texels of all images together. What fits stays in memory. Where all together do not, the
/// largest go to an ImageCache, until the others leave it a quarter of the cap, and ImageCache::kLeastBytes
/// at least; it takes all that they leave.
class ImageMemory {
 public:
  /// `cap` in bytes, at least kLeast.
  explicit ImageMemory(std::size_t cap) : cap_(cap) {}
  static constexpr std::size_t kLeast = std::size_t(16) << 20;

  /// Counts an image that has to stay in memory, named for the message. Throws InputError if it cannot.
  void keep(std::size_t bytes, const std::string& name);

  /// Decides about images of these sizes, after all others that it knows of, and counts them. With `last`
  /// false a place for the cache is left, whether one is needed or not: more images will come, and what is in
  /// memory stays there.
  ImagePlan plan(const std::vector<std::size_t>& bytes, bool last);

  /// The same image with its texels in the cache. For any thread. Throws InputError.
  Image move_to_cache(const Image& image) { return cache_->take(image); }

  std::size_t cap() const { return cap_; }
  ImageMemoryStatistics statistics() const;

  /// What went wrong when texels were read, or "": from then on some were black.
  std::string error() const { return cache_ ? cache_->error() : ""; }

 private:
  std::size_t cap_, in_memory_ = 0;
  std::optional<ImageCache> cache_;
};

}  // namespace parian
