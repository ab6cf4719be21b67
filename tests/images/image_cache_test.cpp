// Images behind the cache against the same images in memory, texel by texel.
#include "images/image_cache.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <random>

#include "renderer/base/error.h"
#include "renderer/base/parallel.h"
#include "renderer/scene/texture.h"
#include "tests/support/scenes.h"

namespace parian {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMiB = std::size_t(1) << 20;

/// Texels of any bits: also those that are no number have to come through.
Image random_image(int width, int height, int channels, PixelType type, std::uint32_t seed) {
  Image image{"noise", width, height, channels, type, {}};
  std::vector<std::byte> bytes(image_bytes(image));
  std::mt19937 random(seed);
  for (std::byte& b : bytes) b = std::byte(random() & 255);
  image.pixels = std::move(bytes);
  return image;
}

bool same_bits(const Vec4f& a, const Vec4f& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// A folder that is $TMPDIR for as long as it lives.
struct TemporaryFolder {
  explicit TemporaryFolder(const std::string& name) : path(fs::path(testing::TempDir()) / name) {
    fs::remove_all(path);
    fs::create_directories(path);
    if (const char* value = std::getenv("TMPDIR")) before = value;
    setenv("TMPDIR", path.c_str(), 1);
  }
  ~TemporaryFolder() {
    before ? setenv("TMPDIR", before->c_str(), 1) : unsetenv("TMPDIR");
    fs::remove_all(path);
  }
  fs::path path;
  std::optional<std::string> before;
};

/// The open file of this process in `folder`, under the name that the system has for it.
fs::path open_file_in(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    if (fs::read_symlink(entry, error).string().starts_with(folder.string())) return entry;
  }
  return {};
}

// Caught: colour multiplied by alpha, half as float, the texels beyond an edge, a wrong neighbour tile.
TEST(ImageCache, GivesTheBitsThatMemoryGives) {
  ImageCache cache;
  cache.limit(ImageCache::kLeastBytes);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> coordinate(-2.5f, 3.5f);
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{200, 131}, {64, 128}, {1, 1}, {3, 300}})
    for (const PixelType type : {PixelType::u8, PixelType::u16, PixelType::f16, PixelType::f32})
      for (int channels = 1; channels <= 4; ++channels) {
        const Image image = random_image(width, height, channels, type, random());
        Scene memory, cached;
        for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge})
          for (const Filter filter : {Filter::nearest, Filter::linear})
            add_texture(memory, image, {0, wrap, Wrap::repeat, filter});
        cached = memory;
        for (Image& i : cached.images) i = cache.take(i);
        EXPECT_TRUE(cached.images[0].pixels.empty());
        for (std::size_t t = 0; t < memory.textures.size(); ++t)
          for (int i = 0; i < 200; ++i) {
            const Vec2f uv(coordinate(random), coordinate(random));
            const ColorSpace space = i % 2 ? ColorSpace::srgb : ColorSpace::linear;
            ASSERT_TRUE(same_bits(eval_texture(memory, memory.textures[t], uv, space),
                                  eval_texture(cached, cached.textures[t], uv, space)))
                << width << "x" << height << "x" << channels << ", type " << int(type) << ", texture " << t;
          }
        for (int y = 0; y < height; y += 7)
          for (int x = 0; x < width; x += 3)
            ASSERT_TRUE(same_bits(texel(image, x, y, ColorSpace::srgb),
                                  texel(cached.images[0], x, y, ColorSpace::srgb)));
      }
  EXPECT_EQ(cache.error(), "");
}

// Caught: a tile taken for another's, one that is freed while a thread reads it, memory beyond the limit.
TEST(ImageCache, StaysWithinItsMemoryWhileThreadsLookUp) {
  ImageCache cache;
  cache.limit(ImageCache::kLeastBytes);
  Scene memory;
  for (int i = 0; i < 4; ++i)
    add_texture(memory,
                random_image(1024, 1000, 4, i % 2 ? PixelType::u16 : PixelType::u8, std::uint32_t(i)));
  Scene cached = memory;
  for (Image& image : cached.images) image = cache.take(image);
  std::atomic<int> differences{0};
  parallel_for(16, 1, [&](std::size_t job) {
    std::mt19937 random{std::uint32_t(job)};
    std::uniform_real_distribution<float> coordinate(0, 1);
    for (int i = 0; i < 3000; ++i) {
      const Vec2f uv(coordinate(random), coordinate(random));
      for (const Texture& texture : memory.textures)
        if (!same_bits(eval_texture(memory, texture, uv, ColorSpace::linear),
                       eval_texture(cached, texture, uv, ColorSpace::linear)))
          ++differences;
    }
  });
  EXPECT_EQ(differences, 0);
  const ImageCacheStatistics statistics = cache.statistics();
  EXPECT_EQ(statistics.file_bytes, std::size_t(16 * 16 * 64 * 64 * 4) * (1 + 2 + 1 + 2));
  EXPECT_GT(statistics.tile_reads, 4u * 16 * 16);  // some more than once: tiles were evicted
  EXPECT_GT(statistics.peak_bytes, ImageCache::kLeastBytes / 2);
  EXPECT_LT(statistics.peak_bytes, ImageCache::kLeastBytes + kMiB);
}

// Caught: images that compare by where they are.
TEST(ImageCache, ImagesCompareByTheirTexels) {
  ImageCache cache, other;
  const Image image = random_image(100, 70, 3, PixelType::u8, 1),
              different = random_image(100, 70, 3, PixelType::u8, 2);
  const Image cached = cache.take(image);
  EXPECT_TRUE(cached == image && image == cached && cached == Image(cached));
  EXPECT_TRUE(cached == other.take(image));
  EXPECT_FALSE(cached == different || different == cached || cached == cache.take(different));
}

// Caught: a thread that takes the tiles of a cache that is gone for those of its successor.
TEST(ImageCache, ImagesOutliveTheCacheAndItsSuccessorsAreOthers) {
  for (std::uint32_t i = 0; i < 20; ++i) {
    const Image image = random_image(100, 70, 3, PixelType::u8, i);
    std::optional<ImageCache> cache(std::in_place);
    const Image cached = cache->take(image);
    cache.reset();
    EXPECT_TRUE(
        same_bits(texel(image, 80, 66, ColorSpace::linear), texel(cached, 80, 66, ColorSpace::linear)));
  }
}

// Caught: bits of an earlier tile in place of those that cannot be read, and an error that nobody hears of.
TEST(ImageCache, WhatCannotBeReadIsBlackAndSaid) {
  const TemporaryFolder folder("parian_lost_texels");
  ImageCache cache;
  const Image cached = cache.take(random_image(200, 200, 4, PixelType::u8, 3));
  EXPECT_NE(texel(cached, 1, 1, ColorSpace::linear), Vec4f(0));
  EXPECT_EQ(cache.error(), "");
  fs::resize_file(open_file_in(folder.path), 0);
  EXPECT_EQ(texel(cached, 199, 199, ColorSpace::linear), Vec4f(0));
  EXPECT_EQ(cache.error(),
            folder.path.string() + ": the temporary file for images cannot be read: it has become shorter");
  EXPECT_EQ(texel(cached, 199, 198, ColorSpace::linear), Vec4f(0));
}

TEST(ImageCache, LeavesNoFile) {
  const TemporaryFolder folder("parian_no_file");
  ImageCache cache;
  const Image cached = cache.take(random_image(200, 200, 4, PixelType::u8, 3));
  EXPECT_FALSE(open_file_in(folder.path).empty());
  EXPECT_TRUE(fs::is_empty(folder.path));
}

TEST(ImageCache, SaysWhereTheDiskIsFullOrTheFolderIsNotThere) {
  const TemporaryFolder folder("parian_full");
  const auto message = [](const auto& act) -> std::string {
    try {
      act();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  // The limit of a file's size stands for the disk's.
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit low{100000, before.rlim_max};
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  ImageCache cache;
  setrlimit(RLIMIT_FSIZE, &low);
  const std::string full = message([&] { cache.take(random_image(300, 300, 4, PixelType::u8, 3)); });
  setrlimit(RLIMIT_FSIZE, &before);
  signal(SIGXFSZ, handler);
  EXPECT_EQ(full, folder.path.string() + ": the temporary file for images cannot be written: File too large");
  fs::remove_all(folder.path);
  EXPECT_EQ(message([] { ImageCache(); }),
            folder.path.string() + ": no temporary file for images can be made: No such file or directory");
}

}  // namespace
}  // namespace parian
