#include "scene_io/image_cache.h"

#include <utility>

#include "renderer/scene/texel_source.h"
#include "scene_io/image_cache_tiles.h"

namespace parian {
namespace {

class CachedTexels final : public TexelSource {
 public:
  CachedTexels(std::shared_ptr<ImageTiles> tiles, const TiledImage& image)
      : tiles_(std::move(tiles)), image_(image) {}
  void fetch(std::span<const Vec2i> places, std::byte* out) const override {
    tiles_->fetch(image_, places, out);
  }

 private:
  std::shared_ptr<ImageTiles> tiles_;
  const TiledImage& image_;
};

}  // namespace

ImageCache::ImageCache() : tiles_(std::make_shared<ImageTiles>()) {}

void ImageCache::limit(std::size_t bytes) { tiles_->limit(bytes); }

Image ImageCache::take(const Image& image) {
  Image taken = image;
  taken.pixels = {};
  taken.source = std::make_shared<CachedTexels>(tiles_, tiles_->add(image));
  return taken;
}

ImageCacheStatistics ImageCache::statistics() const { return tiles_->statistics(); }

std::string ImageCache::error() const { return tiles_->error(); }

}  // namespace parian
