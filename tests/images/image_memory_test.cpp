// Which images stay in memory.
#include "images/image_memory.h"

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

constexpr std::size_t kMiB = std::size_t(1) << 20;

using Numbers = std::vector<std::size_t>;
using Groups = std::vector<Numbers>;

std::vector<std::size_t> mebibytes(std::vector<std::size_t> sizes) {
  for (std::size_t& size : sizes) size *= kMiB;
  return sizes;
}

TEST(ImageMemory, KeepsAllThatFits) {
  ImageMemory memory(100 * kMiB);
  const ImagePlan plan = memory.plan(mebibytes({60, 10, 30}), true);
  EXPECT_EQ(plan.in_memory, (Numbers{1, 2, 0}));
  EXPECT_TRUE(plan.cached.empty());
  EXPECT_EQ(memory.statistics().memory_bytes, 100 * kMiB);
  EXPECT_EQ(memory.statistics().cache_bytes, 0u);
}

// Caught: the smallest in the cache, a cache beside the cap, groups that do not fit beside what is there.
TEST(ImageMemory, SendsTheLargestToTheCache) {
  ImageMemory memory(100 * kMiB);
  const ImagePlan plan = memory.plan(mebibytes({30, 50, 10, 20, 5, 200}), true);
  EXPECT_EQ(plan.in_memory, (Numbers{4, 2, 3, 0}));  // 65, which leaves 35
  EXPECT_EQ(plan.cached, (Groups{{1}, {5}}));
  EXPECT_EQ(memory.statistics().memory_bytes, 65 * kMiB);
  EXPECT_EQ(memory.statistics().cache_bytes, 35 * kMiB);

  ImageMemory small(100 * kMiB);
  EXPECT_EQ(small.plan(mebibytes({20, 20, 20, 20, 20, 20, 20}), true).cached, (Groups{{3, 4}, {5, 6}}));
}

// Caught: a first scene that leaves no room for the cache of a second.
TEST(ImageMemory, LaterScenesFindRoom) {
  ImageMemory memory(100 * kMiB);
  EXPECT_EQ(memory.plan(mebibytes({75}), false).in_memory, (Numbers{0}));
  const ImagePlan plan = memory.plan(mebibytes({10, 20}), true);
  EXPECT_TRUE(plan.in_memory.empty());
  EXPECT_EQ(plan.cached, (Groups{{0}, {1}}));
  EXPECT_EQ(memory.statistics().cache_bytes, 25 * kMiB);

  ImageMemory all(100 * kMiB);
  all.plan(mebibytes({75}), false);
  EXPECT_EQ(all.plan(mebibytes({5, 20}), true).in_memory, (Numbers{0, 1}));
}

TEST(ImageMemory, EnvironmentMapsStay) {
  ImageMemory memory(100 * kMiB);
  memory.keep(40 * kMiB, "sky.exr");
  EXPECT_EQ(memory.plan(mebibytes({30, 31}), true).in_memory, (Numbers{0}));
  EXPECT_THROW(memory.keep(25 * kMiB, "sky.exr"), InputError);  // the cache needs 12 of the 30 left
  memory.keep(18 * kMiB, "sky.exr");
  EXPECT_EQ(memory.statistics().cache_bytes, 12 * kMiB);

  ImageMemory small(100 * kMiB);
  EXPECT_THROW(small.keep(101 * kMiB, "sky.exr"), InputError);
  small.keep(95 * kMiB, "sky.exr");
  EXPECT_THROW(small.plan(mebibytes({6}), true), InputError);  // nothing is left for a cache
}

class ImageMemoryTest : public GltfTest {
 protected:
  /// An EXR file of the size, each pixel its own colour.
  void write_gradient(const std::string& name, int width, int height) const {
    Picture picture{width, height, {"R", "G", "B"}, {}, {}};
    for (int i = 0; i < width * height; ++i)
      for (const int divisor : {1, width, 7}) picture.pixels.push_back(float(i / divisor) / 1000);
    write_exr(picture, path(name));
  }
};

// Caught: an image that is decoded for each texture or each way to write its path, images in a wrong order,
// an environment map in the cache.
TEST_F(ImageMemoryTest, TheSceneIsTheSameWithinACap) {
  write_gradient("large.exr", 1024, 1024);  // 12 MiB
  write_gradient("larger.exr", 1024, 1300);
  write_gradient("sky.exr", 256, 128);
  const std::string small = png(path("small.png"));
  GltfBuilder builder;
  builder.add_triangle()["material"] = 0;
  builder.root["images"] = {{{"uri", "larger.exr"}},
                            {{"uri", "small.png"}},
                            {{"uri", "large.exr"}},
                            {{"uri", "./larger.exr"}},
                            {{"uri", "sky.exr"}}};
  for (int i = 0; i < 4; ++i) builder.root["textures"].push_back({{"source", i}});
  builder.root["materials"] = {
      {{"pbrMetallicRoughness",
        {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
       {"emissiveTexture", {{"index", 2}}},
       {"normalTexture", {{"index", 3}}}}};
  builder.root["extensionsUsed"] = {"EXT_lights_environment"};
  builder.root["extensions"]["EXT_lights_environment"]["environments"] = {{{"source", 4}}};
  builder.root["scenes"] = {{{"extensions", {{"EXT_lights_environment", {{"environment", 0}}}}}}};
  builder.root["scene"] = 0;

  const Scene free = load(builder.glb());
  ASSERT_EQ(free.images.size(), 4u);
  ImageMemory memory(16 * kMiB);
  settings.image_memory = &memory;
  const Scene capped = load_gltf(path("scene.glb"), settings, warnings);
  EXPECT_EQ(free, capped);
  std::size_t cached = 0;
  for (const Image& image : capped.images) {
    EXPECT_EQ(image.source != nullptr, image.height > 1000) << image.name;
    if (image.source) cached += image_bytes(image);
  }
  EXPECT_EQ(cached, 12u * 1024 * (1024 + 1300));
  const ImageMemoryStatistics statistics = memory.statistics();
  EXPECT_EQ(statistics.memory_bytes, 256u * 128 * 12 + 2 * 2 * 3);
  EXPECT_EQ(statistics.memory_bytes + statistics.cache_bytes, 16 * kMiB);
  EXPECT_EQ(statistics.cache.file_bytes, 12u * 1024 * (1024 + 1344));
}

}  // namespace
}  // namespace parian
