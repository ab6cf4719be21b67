// Files that claim to be large, or are, and hold little: refused with the place, soon, and without the
// memory.
#include <gtest/gtest.h>

#include <ctime>

#include "tests/images/support/image_bombs.h"
#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

// In MB, of the process at its largest: of memory that was really touched.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word != "VmHWM:") continue;
    double kilobytes = 0;
    status >> kilobytes;
    return kilobytes / 1000;
  }
  return 0;
}

// Takes no more than some seconds of processor time, a bound that holds with a sanitizer and on a busy
// machine, and 200 MB more than what the process had: what is refused here would take gigabytes.
class GltfLarge : public GltfTest {
 protected:
  void SetUp() override {
    GltfTest::SetUp();
    memory_ = peak_memory();
    start_ = std::clock();
  }
  void TearDown() override {
    EXPECT_LT(peak_memory() - memory_, 200);
    EXPECT_LT(double(std::clock() - start_) / CLOCKS_PER_SEC, 20);
    GltfTest::TearDown();
  }

  void expect_refused(const GltfBuilder& builder, const std::string& place, const std::string& note) {
    const std::string message = refusal(builder.glb());
    EXPECT_EQ(message.substr(0, place.size()), place) << note << ": " << message;
  }

 private:
  double memory_ = 0;
  std::clock_t start_ = 0;
};

// A triangle with indices, a sparse accessor, a stride and instances.
GltfBuilder small_scene() {
  GltfBuilder builder;
  json& mesh = builder.add_triangle();
  mesh["indices"] = builder.add<std::uint16_t>({0, 1, 2}, "SCALAR");
  builder.root["bufferViews"][0]["byteStride"] = 12;
  const int positions = builder.add_view<std::uint8_t>({1});
  const int values = builder.add_view<float>({2, 0, 0});
  builder.root["accessors"][0]["sparse"] = {{"count", 1},
                                            {"indices", {{"bufferView", positions}, {"componentType", 5121}}},
                                            {"values", {{"bufferView", values}}}};
  const int instances = builder.add<float>({0, 0, 0, 2, 0, 0}, "VEC3");
  builder.root["nodes"] = {{{"mesh", 0}}};
  builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = instances;
  builder.root["scenes"] = {{{"nodes", {0}}}};
  builder.root["buffers"] = {{{"byteLength", builder.binary.size()}}};
  return builder;
}

TEST_F(GltfLarge, ReadsTheSceneThatIsBrokenBelow) { EXPECT_EQ(refusal(small_scene().glb()), ""); }

// Cut anywhere, with a header that says what is there or what was there.
TEST_F(GltfLarge, RefusesAFileCutAnywhere) {
  const std::string glb = small_scene().glb();
  for (std::size_t size = 0; size < glb.size(); ++size) {
    std::string cut = glb.substr(0, size);
    EXPECT_NE(refusal(cut), "") << size;
    if (size < 12) continue;
    cut.replace(8, 4, GltfBuilder::u32(std::uint32_t(size)));
    EXPECT_NE(refusal(cut), "") << size;
  }
}

TEST_F(GltfLarge, RefusesNumbersThatWrapAround) {
  const std::vector<std::string> places = {"/accessors/0/count",
                                           "/accessors/0/byteOffset",
                                           "/accessors/0/sparse/count",
                                           "/accessors/0/sparse/indices/byteOffset",
                                           "/accessors/0/sparse/values/byteOffset",
                                           "/accessors/1/count",
                                           "/accessors/1/byteOffset",
                                           "/accessors/2/count",
                                           "/bufferViews/0/byteOffset",
                                           "/bufferViews/0/byteLength",
                                           "/bufferViews/0/byteStride",
                                           "/buffers/0/byteLength"};
  const std::vector<json> values = {2147483647,
                                    2147483648u,
                                    2147483649u,
                                    4294967292u,
                                    4294967295u,
                                    4294967296u,
                                    4294967297u,
                                    4294967299u,
                                    1431655766u,  // a third of 2^32, times 12
                                    9007199254740991u,
                                    9007199254740992u,
                                    6148914691236517206u,
                                    9223372036854775807u,
                                    18446744073709551615u,
                                    1e300,
                                    -1,
                                    -4294967295,
                                    -1e300,
                                    0.5,
                                    2.5,
                                    nullptr,
                                    "4294967295",
                                    true};
  for (const std::string& place : places) {
    for (const json& value : values) {
      GltfBuilder broken = small_scene();
      broken.root[json::json_pointer(place)] = value;
      // Where the sum is what does not fit, the message may be about the length or count beside the place.
      expect_refused(broken, place.substr(0, place.find('/', 1) + 2), place + " = " + value.dump());
    }
  }
}

TEST_F(GltfLarge, RefusesChunksThatWrapAround) {
  const std::string glb = small_scene().glb();
  std::uint32_t json_bytes = 0;
  std::memcpy(&json_bytes, glb.data() + 12, 4);
  for (const std::uint32_t claim : {0xFFFFFFFFu, 0xFFFFFFFCu, 0xFFFFFFF0u, 0xFFFFFFECu, 0xFFFFFFE8u,
                                    0x80000000u, 0x7FFFFFFFu, std::uint32_t(glb.size())}) {
    for (const std::size_t at : {std::size_t(12), std::size_t(20 + json_bytes)}) {
      std::string broken = glb;
      broken.replace(at, 4, GltfBuilder::u32(claim));
      EXPECT_EQ(refusal(broken).substr(0, 5), "byte ") << claim << " at " << at;
      broken.replace(8, 4, GltfBuilder::u32(0xFFFFFFFFu));
      EXPECT_EQ(refusal(broken).substr(0, 7), "byte 8:") << claim << " at " << at;
    }
  }
}

TEST_F(GltfLarge, RefusesArraysOfTwoThousandMillion) {
  for (const auto& [accessor, what] :
       {std::pair(0, "positions"), std::pair(1, "indices"), std::pair(2, "instances")}) {
    for (const bool has_bytes : {true, false}) {
      GltfBuilder broken = small_scene();
      json& claim = broken.root["accessors"][accessor];
      claim["count"] = 2147483648u;
      if (!has_bytes) claim.erase("bufferView");
      // That indices are never all zeros is seen first.
      expect_refused(broken,
                     accessor == 1 && !has_bytes ? "/meshes/0/primitives/0/indices: expected"
                                                 : fmt::format("/accessors/{}/count: expected", accessor),
                     what);
    }
  }
}

// Each of them is honest by itself: 1000 times 1.2 MB out of 0.3 MB.
TEST_F(GltfLarge, RefusesManyArraysOverTheSameBytes) {
  GltfBuilder builder = small_scene();
  const int bytes = builder.add_view(std::vector<std::uint8_t>(300'000));
  builder.root["buffers"][0]["byteLength"] = builder.binary.size();
  json& primitives = builder.root["meshes"][0]["primitives"];
  for (int i = 0; i < 1000; ++i) {
    primitives.push_back({{"attributes", {{"POSITION", builder.root["accessors"].size()}}}});
    builder.root["accessors"].push_back(
        {{"bufferView", bytes}, {"componentType", 5121}, {"type", "VEC3"}, {"count", 99'999}});
  }
  const std::string message = refusal(builder.glb());
  EXPECT_EQ(message.substr(0, 21), "/meshes/0/primitives/") << message;
  EXPECT_NE(message.find("repeat the same bytes"), std::string::npos) << message;
}

TEST_F(GltfLarge, ReadsManyMeshesOfNothing) {
  GltfBuilder builder = small_scene();
  for (int i = 0; i < 50'000; ++i) builder.root["meshes"].push_back({{"primitives", json::array()}});
  EXPECT_EQ(load(builder.glb()).meshes.size(), 50'001u);
}

TEST_F(GltfLarge, RefusesImagesThatClaimToBeHuge) {
  constexpr int kSide = 60'000;
  const std::vector<std::pair<std::string, std::string>> bombs = {
      {"png", png_bomb(kSide, false)},
      {"interlaced png", png_bomb(kSide, true)},
      {"smaller png", png_bomb(9'000, true)},
      {"jpeg", jpeg_bomb(kSide, false)},
      {"progressive jpeg", jpeg_bomb(kSide, true)},
      {"smaller jpeg", jpeg_bomb(9'000, true)},
      {"hdr", hdr_bomb(kSide)},
      {"exr", exr_bomb(kSide)},
      {"exr of tiles", exr_bomb(kSide, 64)},
      {"exr of pixels", exr_bomb(kSide, 1)},
      {"exr of one tile", exr_bomb(kSide, kSide)},
      {"exr of all numbers", exr_bomb(0x7FFFFFFF)}};
  for (const auto& [name, bytes] : bombs) {
    GltfBuilder builder = small_scene();
    builder.root["images"] = {{{"bufferView", builder.add_bytes(bytes)}}};
    builder.root["buffers"][0]["byteLength"] = builder.binary.size();
    builder.root["textures"] = {{{"source", 0}}};
    builder.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}, {"emissiveFactor", {1, 1, 1}}}};
    expect_refused(builder, "/images/0: ", name);
    EXPECT_LT(bytes.size(), 1000u);
  }
}

}  // namespace
}  // namespace parian
