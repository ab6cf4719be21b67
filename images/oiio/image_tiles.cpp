#include "images/oiio/image_tiles.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <utility>

#include "images/oiio/library.h"
#include "images/oiio/oiio_type.h"
#include "renderer/base/error.h"

namespace parian::oiio {
namespace {

constexpr int kTile = TiledImage::kTile;
constexpr const char* kAttribute = "parian:image";  // passes a TiledImage to the reader

// Of the limit, what the cache is told, which frees tiles when it is over.
constexpr double kShare = 15.0 / 16;

std::uint64_t next_serial() {
  static std::atomic<std::uint64_t> serial{0};
  return ++serial;
}

// What OpenImageIO's cache reads the file by.
class TileReader final : public OIIO::ImageInput {
 public:
  const char* format_name() const override { return "parian tiles"; }
  bool open(const std::string&, OIIO::ImageSpec&) override { return false; }
  bool open(const std::string&, OIIO::ImageSpec& spec, const OIIO::ImageSpec& config) override {
    void* image = nullptr;
    if (!config.getattribute(kAttribute, OIIO::TypeDesc::PTR, &image)) return false;
    image_ = static_cast<const TiledImage*>(image);
    spec = m_spec = image_->spec;
    return true;
  }
  bool close() override { return true; }
  bool read_native_scanline(int, int, int, int, void*) override { return false; }
  bool read_native_tile(int, int, int x, int y, int, void* out) override {
    image_->tiles->read_tile(*image_, x, y, out);
    return true;
  }

 private:
  const TiledImage* image_ = nullptr;
};

OIIO::ImageInput* make_reader() { return new TileReader; }

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

TiledImage::TiledImage(const Image& image)
    : spec(image.width, image.height, image.channels, oiio_type(image.type)),
      pixel_bytes(parian::pixel_bytes(image)) {
  spec.tile_width = spec.tile_height = kTile;
  spec.tile_depth = 1;
}

ImageTiles::ImageTiles() : serial_(next_serial()), cache_(OIIO::ImageCache::create(false)) {
  limit(std::size_t(256) << 20);
  cache_->attribute("failure_retries", 0);
  cache_->attribute("max_open_files", 1 << 20);  // they are one file, and it is open
}

ImageTiles::~ImageTiles() {
  for (auto& [thread, mine] : threads_) {
    for (const ThreadTiles::Slot& slot : mine->slots)
      if (slot.tile) cache_->release_tile(slot.tile);
    cache_->destroy_thread_info(mine->info);
  }
  OIIO::ImageCache::destroy(cache_);
}

void ImageTiles::limit(std::size_t bytes) {
  limit_ = bytes;
  cache_->attribute("max_memory_MB", float(kShare * double(bytes) / (1 << 20)));
  // What threads hold on to, at 16 bytes a pixel, is half of it at most.
  const std::size_t tiles = bytes / 2 / (std::size_t(library_threads()) * kTile * kTile * 16);
  slot_mask_ =
      std::bit_floor(std::clamp<std::size_t>(tiles, 1, std::tuple_size_v<decltype(ThreadTiles::slots)>)) - 1;
}

Image ImageTiles::take(const Image& image) {
  Image taken = image;
  taken.pixels = {};
  taken.source = std::make_shared<CachedTexels>(shared_from_this(), add(image));
  return taken;
}

const TiledImage& ImageTiles::add(const Image& image) {
  auto added = std::make_unique<TiledImage>(image);
  added->tiles = this;
  added->offset = file_bytes_.fetch_add(added->tile_bytes() * added->across() * added->down());
  write(*added, image);

  const std::lock_guard lock(mutex_);
  added->number = int(images_.size());
  const OIIO::ustring name(fmt::format("parian image {}", added->number));
  OIIO::ImageSpec config;
  void* pointer = added.get();
  config.attribute(kAttribute, OIIO::TypeDesc::PTR, &pointer);
  if (cache_->add_file(name, make_reader, &config)) added->handle = cache_->get_image_handle(name);
  if (!added->handle)
    throw InputError(image.name, "", "OpenImageIO's cache does not take it: " + cache_->geterror());
  return *images_.emplace_back(std::move(added));
}

void ImageTiles::write(const TiledImage& tiled, const Image& image) {
  std::vector<std::byte> row(tiled.tile_bytes() * tiled.across());
  const std::size_t stride = image.width * tiled.pixel_bytes;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; x += kTile)
      std::memcpy(row.data() + tiled.tile_bytes() * (x / kTile) + y % kTile * kTile * tiled.pixel_bytes,
                  image.pixels.data() + stride * y + tiled.pixel_bytes * x,
                  tiled.pixel_bytes * std::min(kTile, image.width - x));
    if (y % kTile == kTile - 1 || y == image.height - 1)
      file_.write(row, tiled.offset + tiled.tile_bytes() * tiled.index(0, y));
  }
}

void ImageTiles::read_tile(const TiledImage& image, int x, int y, void* out) {
  await_room();
  const std::span bytes(static_cast<std::byte*>(out), image.tile_bytes());
  const std::string problem = file_.read(bytes, image.offset + image.tile_bytes() * image.index(x, y));
  if (!problem.empty()) {
    std::ranges::fill(bytes, std::byte(0));
    fail(problem);
  }
  ++tile_reads_;
  const std::size_t used = memory_used();
  for (std::size_t peak = peak_bytes_; peak < used;)
    if (peak_bytes_.compare_exchange_weak(peak, used)) break;
}

// One thread at a time frees tiles, and the cache lets the others read on, by megabytes where that thread is
// not running. So they wait for it; not for ever, since it may be that nothing can be freed.
void ImageTiles::await_room() const {
  for (int i = 0; i < 100 && memory_used() > limit_; ++i)
    std::this_thread::sleep_for(std::chrono::microseconds(100));
}

ThreadTiles& ImageTiles::of_this_thread() {
  // By serial number, since another cache may come to lie at this one's address.
  thread_local std::pair<std::uint64_t, ThreadTiles*> last{0, nullptr};
  if (last.first == serial_) return *last.second;
  const std::lock_guard lock(mutex_);
  std::unique_ptr<ThreadTiles>& mine = threads_[std::this_thread::get_id()];
  if (!mine) {
    mine = std::make_unique<ThreadTiles>();
    mine->info = cache_->create_thread_info();
  }
  last = {serial_, mine.get()};
  return *mine;
}

const std::byte* ImageTiles::find_tile(const TiledImage& image, ThreadTiles& mine, const Vec2i& p) {
  const int index = image.index(p.x, p.y);
  // The four tiles at a corner, and the same place of four images, have slots of their own.
  const std::size_t place = std::size_t(p.x / kTile + p.y / kTile * 2 + image.number * 4);
  ThreadTiles::Slot& slot = mine.slots[place & slot_mask_];
  if (slot.image == &image && slot.index == index) return slot.pixels;
  if (slot.tile) cache_->release_tile(slot.tile);
  slot = {&image, index, cache_->get_tile(image.handle, mine.info, 0, 0, p.x, p.y, 0), nullptr};
  OIIO::TypeDesc format;
  if (slot.tile) slot.pixels = static_cast<const std::byte*>(cache_->tile_pixels(slot.tile, format));
  if (slot.pixels && format == image.spec.format) return slot.pixels;
  fail("OpenImageIO's cache does not give a tile of an image: " + cache_->geterror());
  return slot.pixels = nullptr;
}

void ImageTiles::fetch(const TiledImage& image, std::span<const Vec2i> places, std::byte* out) {
  ThreadTiles& mine = of_this_thread();
  for (const Vec2i& p : places) {
    if (const std::byte* tile = find_tile(image, mine, p))
      std::memcpy(out, tile + (p.y % kTile * kTile + p.x % kTile) * image.pixel_bytes, image.pixel_bytes);
    else
      std::memset(out, 0, image.pixel_bytes);
    out += image.pixel_bytes;
  }
}

void ImageTiles::fail(const std::string& what) {
  const std::lock_guard lock(mutex_);
  if (error_.empty()) error_ = what;
}

std::string ImageTiles::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

std::size_t ImageTiles::memory_used() const {
  long long used = 0;
  cache_->getattribute("stat:cache_memory_used", OIIO::TypeDesc::INT64, &used);
  return std::size_t(used);
}

ImageCacheStatistics ImageTiles::statistics() const {
  return {file_bytes_, std::max<std::size_t>(peak_bytes_, memory_used()), tile_reads_};
}

std::shared_ptr<TileCache> make_tile_cache() { return std::make_shared<ImageTiles>(); }

}  // namespace parian::oiio
