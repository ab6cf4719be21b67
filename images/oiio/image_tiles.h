/// An ImageCache by OpenImageIO.
#pragma once

#include <OpenImageIO/imagecache.h>

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <unordered_map>
#include <vector>

#include "images/oiio/library.h"
#include "images/oiio/tile_file.h"
#include "renderer/scene/texel_source.h"

namespace parian::oiio {

class ImageTiles;

/// An image in the file: tiles row by row, each kTile x kTile pixels, also at the edges.
struct TiledImage {
  static constexpr int kTile = 64;  // 16 kB of 8-bit RGBA

  explicit TiledImage(const Image& image);
  int across() const { return (spec.width + kTile - 1) / kTile; }
  int down() const { return (spec.height + kTile - 1) / kTile; }
  int index(int x, int y) const { return y / kTile * across() + x / kTile; }
  std::size_t tile_bytes() const { return std::size_t(kTile) * kTile * pixel_bytes; }

  ImageTiles* tiles = nullptr;
  OIIO::ImageSpec spec;
  std::size_t pixel_bytes;
  std::uint64_t offset = 0;  // in the file
  int number = 0;
  OIIO::ImageCache::ImageHandle* handle = nullptr;
};

/// The tiles that a thread used last. Those that it finds here it need not ask the cache for, which takes a
/// lock and counts references; the cache counts them as memory all the same.
struct ThreadTiles {
  struct Slot {
    const TiledImage* image = nullptr;
    int index = 0;
    OIIO::ImageCache::Tile* tile = nullptr;
    const std::byte* pixels = nullptr;
  };
  std::array<Slot, 16> slots;
  OIIO::ImageCache::Perthread* info = nullptr;
};

class ImageTiles final : public TileCache, public std::enable_shared_from_this<ImageTiles> {
 public:
  ImageTiles();
  ~ImageTiles() override;
  ImageTiles(const ImageTiles&) = delete;
  ImageTiles& operator=(const ImageTiles&) = delete;

  void limit(std::size_t bytes) override;
  Image take(const Image& image) override;
  ImageCacheStatistics statistics() const override;
  std::string error() const override;

  void fetch(const TiledImage& image, std::span<const Vec2i> places, std::byte* out);

  /// The tile at pixel (x, y), from the file. Where that cannot be read it is black.
  void read_tile(const TiledImage& image, int x, int y, void* out);

 private:
  const TiledImage& add(const Image& image);
  void write(const TiledImage& tiled, const Image& image);
  ThreadTiles& of_this_thread();
  const std::byte* find_tile(const TiledImage& image, ThreadTiles& mine, const Vec2i& p);
  void fail(const std::string& what);
  std::size_t memory_used() const;
  void await_room() const;

  const std::uint64_t serial_;
  TileFile file_;
  OIIO::ImageCache* cache_;
  std::size_t limit_ = 0, slot_mask_ = 0;
  std::atomic<std::uint64_t> file_bytes_{0}, tile_reads_{0};
  std::atomic<std::size_t> peak_bytes_{0};
  mutable std::mutex mutex_;  // of what follows
  std::string error_;
  std::unordered_map<std::thread::id, std::unique_ptr<ThreadTiles>> threads_;
  std::vector<std::unique_ptr<TiledImage>> images_;
};

}  // namespace parian::oiio
