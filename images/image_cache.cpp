#include "images/image_cache.h"

#include "images/image_library.h"

namespace parian {

ImageCache::ImageCache() : tiles_(image_library().make_tile_cache()) {}

void ImageCache::limit(std::size_t bytes) { tiles_->limit(bytes); }

Image ImageCache::take(const Image& image) { return tiles_->take(image); }

ImageCacheStatistics ImageCache::statistics() const { return tiles_->statistics(); }

std::string ImageCache::error() const { return tiles_->error(); }

}  // namespace parian
