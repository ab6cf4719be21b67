// EXT_meshopt_compression: what is decoded is what was encoded, and broken streams are refused.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "renderer/base/memory.h"
#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

constexpr const char* kExtension = "EXT_meshopt_compression";
constexpr std::uint32_t kSide =
    20;  // of the grid, in vertices: several blocks of the codec, the last one not full

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string encode(const std::string& bytes, std::size_t stride, const std::string& mode) {
  const std::size_t count = bytes.size() / stride;
  std::vector<unsigned char> stream(16 * bytes.size() + 1024);
  std::size_t size = 0;
  if (mode == "ATTRIBUTES") {
    meshopt_encodeVertexVersion(0);
    size = meshopt_encodeVertexBuffer(stream.data(), stream.size(), bytes.data(), count, stride);
  } else {
    std::vector<unsigned int> indices(count);
    for (std::size_t i = 0; i < count; ++i) std::memcpy(&indices[i], bytes.data() + i * stride, stride);
    meshopt_encodeIndexVersion(1);
    const auto encoder = mode == "TRIANGLES" ? &meshopt_encodeIndexBuffer<unsigned int>
                                             : &meshopt_encodeIndexSequence<unsigned int>;
    size = encoder(stream.data(), stream.size(), indices.data(), count);
  }
  EXPECT_GT(size, 0u);
  return {reinterpret_cast<const char*>(stream.data()), size};
}

class GltfMeshopt : public GltfTest {
 protected:
  /// A bufferView `number` of `builder` becomes one whose bytes are decoded from `stream`. The first time the
  /// bytes that were there become a fallback, buffer 1.
  static void set_stream(GltfBuilder& builder, int number, const std::string& stream, std::size_t stride,
                         const std::string& mode, const std::string& filter = "") {
    if (!builder.root.contains("buffers")) {
      builder.root["buffers"] = {{{"byteLength", 0}}, {{"byteLength", builder.binary.size()}}};
      builder.root["buffers"][1]["extensions"][kExtension]["fallback"] = true;
      for (json& view : builder.root["bufferViews"]) view["buffer"] = 1;
      builder.binary.clear();
      builder.root["extensionsUsed"].push_back(kExtension);
      builder.root["extensionsRequired"].push_back(kExtension);
    }
    json& view = builder.root["bufferViews"][std::size_t(number)];
    json& extension = view["extensions"][kExtension];
    extension = {{"buffer", 0},
                 {"byteOffset", builder.binary.size()},
                 {"byteLength", stream.size()},
                 {"byteStride", stride},
                 {"mode", mode},
                 {"count", view["byteLength"].get<std::size_t>() / stride}};
    if (!filter.empty()) extension["filter"] = filter;
    builder.binary += stream;
    builder.root["buffers"][0]["byteLength"] = builder.binary.size();
  }

  /// The same, encoding the bytes of the view in `plain`.
  static void compress(GltfBuilder& builder, const GltfBuilder& plain, int number, std::size_t stride,
                       const std::string& mode) {
    const json& view = plain.root["bufferViews"][std::size_t(number)];
    const std::string bytes = plain.binary.substr(view["byteOffset"], view["byteLength"]);
    set_stream(builder, number, encode(bytes, stride, mode), stride, mode);
  }

  /// A hilly square with normals of 4 bytes and uvs of 4, indices of T.
  template <class T>
  static GltfBuilder grid() {
    std::vector<float> positions;
    std::vector<std::int8_t> normals;
    std::vector<std::uint16_t> uvs;
    std::vector<T> indices;
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      const float x = float(i % kSide), y = float(i / kSide);
      for (const float p : {x, y, std::sin(x) * std::cos(0.3f * y)}) positions.push_back(p);
      for (const int n : {int(i % 7) - 3, int(i % 5) - 2, 120, 0}) normals.push_back(std::int8_t(n));
      for (const std::uint32_t u : {i % kSide, i / kSide}) uvs.push_back(std::uint16_t(u * 3000));
      if (i % kSide == kSide - 1 || i / kSide == kSide - 1) continue;
      for (const std::uint32_t c : {i, i + 1, i + kSide, i + kSide, i + 1, i + kSide + 1})
        indices.push_back(T(c));
    }
    GltfBuilder builder;
    const int position = builder.add(positions, "VEC3"), normal = builder.add(normals, "VEC4", true),
              uv = builder.add(uvs, "VEC2", true), index = builder.add(indices, "SCALAR");
    builder.root["accessors"][std::size_t(normal)]["type"] = "VEC3";
    builder.root["bufferViews"][std::size_t(normal)]["byteStride"] = 4;
    builder.use_extension("KHR_mesh_quantization");
    json& mesh = builder.add_mesh({{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}});
    mesh["indices"] = index;
    builder.root["nodes"] = {{{"mesh", 0}}};
    return builder;
  }

  template <class T>
  static GltfBuilder compressed_grid() {
    const GltfBuilder plain = grid<T>();
    GltfBuilder builder = plain;
    compress(builder, plain, 0, 12, "ATTRIBUTES");
    compress(builder, plain, 1, 4, "ATTRIBUTES");
    compress(builder, plain, 2, 4, "ATTRIBUTES");
    compress(builder, plain, 3, sizeof(T), "TRIANGLES");
    return builder;
  }

  /// Every so-maniest byte of the streams with a bit flipped: any exception but InputError ends the test.
  void flip_bytes(std::size_t step) {
    const GltfBuilder good = compressed_grid<std::uint16_t>();
    int refused = 0;
    for (std::size_t i = 0; i < good.binary.size(); i += step) {
      GltfBuilder bad = good;
      bad.binary[i] = char(bad.binary[i] ^ (1 << i % 8));
      refused += !refusal(bad.glb()).empty();
    }
    EXPECT_GT(refused, int(good.binary.size() / step / 100));
  }

  /// A VEC3 or VEC4 attribute of three vertices, stored as `filtered` elements that a filter turns into T.
  template <class T>
  Primitive filtered(const std::string& name, const std::string& bytes, std::size_t stride,
                     const std::string& filter) {
    GltfBuilder builder;
    json& mesh = builder.add_triangle();
    const int accessor = builder.add(std::vector<T>(3 * stride / sizeof(T)), "SCALAR");
    builder.root["accessors"][1].update({{"type", name == "TANGENT" ? "VEC4" : "VEC3"},
                                         {"count", 3},
                                         {"normalized", !std::is_same_v<T, float>}});
    builder.root["bufferViews"][1]["byteStride"] = stride;
    mesh["attributes"][name] = accessor;
    const GltfBuilder plain = builder;
    compress(builder, plain, 0, 12, "ATTRIBUTES");
    set_stream(builder, 1, encode(bytes, stride, "ATTRIBUTES"), stride, "ATTRIBUTES", filter);
    return load(builder.glb()).meshes.at(0).primitives.at(0);
  }
};

/// The codec of triangles may turn them: the least corner first.
void turn_triangles(Scene& scene) {
  auto& triangles = scene.meshes.at(0).primitives.at(0).triangles;
  std::vector<Triangle> turned(triangles.begin(), triangles.end());
  for (Triangle& t : turned) std::ranges::rotate(t, std::ranges::min_element(t));
  triangles = turned;
}

TEST_F(GltfMeshopt, ReadsWhatItReadsUncompressed) {
  Scene plain = load(grid<std::uint16_t>().glb());
  ASSERT_EQ(plain.meshes[0].primitives[0].triangles.size(), 2 * (kSide - 1) * (kSide - 1));
  turn_triangles(plain);
  for (const GltfBuilder& builder : {compressed_grid<std::uint16_t>(), compressed_grid<std::uint32_t>()}) {
    Scene scene = load(builder.glb());
    turn_triangles(scene);
    EXPECT_EQ(scene, plain);
    EXPECT_EQ(warnings, std::vector<std::string>());
  }
}

TEST_F(GltfMeshopt, ReadsSequencesOfIndices) {
  for (const int mode : {4, 5, 6}) {
    GltfBuilder plain = grid<std::uint16_t>();
    plain.root["meshes"][0]["primitives"][0]["mode"] = mode;
    GltfBuilder builder = plain;
    compress(builder, plain, 3, 2, "INDICES");
    for (const int view : {0, 1, 2}) compress(builder, plain, view, 4, "ATTRIBUTES");
    EXPECT_EQ(load(builder.glb()), load(plain.glb())) << mode;
  }
}

// Unit vectors at 45 degrees, in 8 and in 16 bits; the fourth component passes.
TEST_F(GltfMeshopt, DecodesOctahedralDirections) {
  const std::vector<std::int8_t> small = {64, 0, 127, 0, 0, -64, 127, 0, -127, 64, 127, 0};
  const Primitive p = filtered<std::int8_t>("NORMAL", bytes_of(small), 4, "OCTAHEDRAL");
  const float h = std::sqrt(0.5f);
  EXPECT_LT((p.normals[0] - Vec3f(h, 0, h)).length(), 0.02f);
  EXPECT_LT((p.normals[1] - Vec3f(0, -h, h)).length(), 0.02f);
  EXPECT_LT((p.normals[2] - Vec3f(-h, 0, -h)).length(), 0.8f);  // below the equator
  EXPECT_LT(p.normals[2].z, -0.1f);

  const std::vector<std::int16_t> large = {16384, 0, 32767, 0, 0, -16384, 32767, 0, 511, 0, 1023, 0};
  const Primitive q = filtered<std::int16_t>("NORMAL", bytes_of(large), 8, "OCTAHEDRAL");
  EXPECT_LT((q.normals[0] - Vec3f(h, 0, h)).length(), 1e-4f);
  EXPECT_LT((q.normals[1] - Vec3f(0, -h, h)).length(), 1e-4f);
  EXPECT_LT((q.normals[2] - Vec3f(h, 0, h)).length(), 2e-3f);  // 11 bits
}

// 2^exponent * mantissa, the exponent in the high byte.
TEST_F(GltfMeshopt, DecodesExponents) {
  const auto encoded = [](int exponent, int mantissa) {
    return std::uint32_t(exponent) << 24 | (std::uint32_t(mantissa) & 0xFFFFFFu);
  };
  const std::vector<std::uint32_t> values = {encoded(0, 1),         encoded(-2, 3),  encoded(1, -5),
                                             encoded(-23, 1 << 20), encoded(4, 0),   encoded(0, -7),
                                             encoded(3, 3),         encoded(-1, -1), encoded(0, 0)};
  const Primitive p = filtered<float>("POSITION", bytes_of(values), 12, "EXPONENTIAL");
  EXPECT_EQ(p.positions[0], Vec3f(1, 0.75f, -10));
  EXPECT_EQ(p.positions[1], Vec3f(0.125f, 0, -7));
  EXPECT_EQ(p.positions[2], Vec3f(24, -0.5f, 0));
}

TEST_F(GltfMeshopt, DecodesQuaternions) {
  const std::array<float, 4> rotation = {0.1f, -0.7f, 0.5f, 0.5f};
  std::vector<std::int16_t> encoded(8);
  const std::array<float, 8> both = {rotation[0], rotation[1], rotation[2], rotation[3], 0, 0, 0, 1};
  meshopt_encodeFilterQuat(encoded.data(), 2, 8, 16, both.data());
  GltfBuilder builder;
  builder.add_triangle();
  const int accessor = builder.add(std::vector<std::int16_t>(8), "VEC4", true);
  const GltfBuilder plain = builder;
  compress(builder, plain, 0, 12, "ATTRIBUTES");
  set_stream(builder, 1, encode(bytes_of(encoded), 8, "ATTRIBUTES"), 8, "ATTRIBUTES", "QUATERNION");
  builder.root["nodes"] = {{{"mesh", 0}}};
  builder.root["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = accessor;
  const auto instances = load(builder.glb()).nodes.at(0).instances;
  ASSERT_EQ(instances.size(), 2u);
  const auto& q = instances[0].rotation;
  const float sign = q.r * rotation[3] > 0 ? 1.0f : -1.0f;  // both mean the same rotation
  EXPECT_LT((Vec3f(q.v) * sign - Vec3f(rotation[0], rotation[1], rotation[2])).length(), 1e-3f);
  EXPECT_NEAR(std::abs(instances[1].rotation.r), 1, 1e-4f);
}

TEST_F(GltfMeshopt, NeverReadsAFallback) {
  GltfBuilder builder = compressed_grid<std::uint16_t>();
  const Scene scene = load(builder.glb());
  builder.root["buffers"][1].erase("extensions");  // marking it is optional
  EXPECT_EQ(load(builder.glb()), scene);
  builder.root["buffers"][1]["uri"] = "not-there.bin";
  EXPECT_EQ(load(builder.glb()), scene);
}

TEST_F(GltfMeshopt, ReadsAViewThatIsNotCompressedBesides) {
  const GltfBuilder plain = grid<std::uint16_t>();
  GltfBuilder builder = plain;
  for (const int view : {0, 1, 2}) compress(builder, plain, view, 4, "ATTRIBUTES");
  const json& view = plain.root["bufferViews"][3];
  builder.root["bufferViews"][3]["buffer"] = 2;
  builder.root["buffers"][2] = {{"byteLength", plain.binary.size()},
                                {"uri", "data:application/octet-stream;base64," + base64(plain.binary)}};
  ASSERT_EQ(view["buffer"], 0);
  EXPECT_EQ(load(builder.glb()), load(plain.glb()));
}

struct Mutation {
  std::string place;
  json value;
  std::string expected = place + ": expected";
};

TEST_F(GltfMeshopt, RefusesWhatTheSpecificationExcludes) {
  const GltfBuilder good = compressed_grid<std::uint16_t>();
  const std::string a = "/bufferViews/0/extensions/EXT_meshopt_compression",
                    i = "/bufferViews/3" + a.substr(14);
  const std::vector<Mutation> mutations = {
      {a, 1},
      {a + "/buffer", 2},
      {a + "/buffer", 1, a + "/buffer: expected a buffer that is not marked as a fallback"},
      {a + "/byteOffset", -1},
      {a + "/byteOffset", 1e9, a + "/byteLength: expected byteOffset + byteLength of at most"},
      {a + "/byteOffset", 9e15, a + "/byteLength: expected byteOffset + byteLength of at most"},
      {a + "/byteLength", 0},
      {a + "/byteLength", 9e15},
      {a + "/byteLength", 30, a + "/byteLength: expected at least"},
      {a + "/byteStride", 260},
      {a + "/byteStride", 6, a + "/byteStride: expected a multiple of 4"},
      {a + "/byteStride", 8, "/bufferViews/0/byteLength: expected 3200"},
      {a + "/count", 0},
      {a + "/count", 4e9},
      {a + "/count", 399, "/bufferViews/0/byteLength: expected"},
      {a + "/mode", "VERTICES"},
      {a + "/mode", "TRIANGLES", a + "/byteStride: expected 2 or 4"},
      {a + "/filter", "ZIGZAG"},
      {a + "/filter", "OCTAHEDRAL", a + "/byteStride: expected 4 or 8"},
      {a + "/filter", "QUATERNION", a + "/byteStride: expected 8"},
      {i + "/filter", "EXPONENTIAL", i + "/filter: expected \"NONE\""},
      {i + "/byteStride", 3, i + "/byteStride: expected 2 or 4"},
      {i + "/count", 2167, i + "/count: expected a multiple of 3"},
      {"/bufferViews/0/byteLength", 4796},
      {"/bufferViews/0/byteStride", 16, a + "/byteStride: expected the byteStride of the bufferView"},
      {"/buffers/1/byteLength", 4799,
       "/bufferViews/0/byteLength: expected byteOffset + byteLength of at most 4799"},
      {"/buffers/1/extensions/EXT_meshopt_compression/fallback", 1},
      {"/bufferViews/0/extensions", json::object(),
       "/bufferViews/0/buffer: expected a buffer that is not marked"},
  };
  for (const Mutation& mutation : mutations) {
    GltfBuilder bad = good;
    bad.root[json::json_pointer(mutation.place)] = mutation.value;
    const std::string message = refusal(bad.glb());
    EXPECT_EQ(message.substr(0, mutation.expected.size()), mutation.expected)
        << mutation.place << " = " << mutation.value << ": " << message;
  }
}

// The library reads older and newer formats than the extension has.
TEST_F(GltfMeshopt, RefusesOtherVersionsOfTheFormat) {
  const GltfBuilder good = compressed_grid<std::uint16_t>();
  for (const std::size_t view : {0, 3}) {
    for (const int header : {0xA1, 0xE0, 0xD0}) {
      GltfBuilder bad = good;
      const std::size_t offset = bad.root["bufferViews"][view]["extensions"][kExtension]["byteOffset"];
      bad.binary[offset] = char(header);
      EXPECT_TRUE(refusal(bad.glb()).starts_with(fmt::format(
          "/bufferViews/{}/extensions/EXT_meshopt_compression: expected a stream of mode", view)));
    }
  }
}

// The codecs have a least number of bytes for an element: what a stream cannot hold is refused unallocated.
TEST_F(GltfMeshopt, RefusesCountsThatNoStreamOfThatLengthHolds) {
  for (const auto& [mode, stride] : std::vector<std::pair<std::string, std::uint64_t>>{
           {"ATTRIBUTES", 256}, {"ATTRIBUTES", 4}, {"TRIANGLES", 4}, {"INDICES", 4}}) {
    for (const std::uint64_t count : {3'000'000u, 2'147'483'646u}) {
      GltfBuilder bad = compressed_grid<std::uint16_t>();
      json& view = bad.root["bufferViews"][3];
      view["byteLength"] = count * stride;
      view["byteOffset"] = 0;
      bad.root["buffers"][1]["byteLength"] = count * stride;
      view["extensions"][kExtension].update({{"mode", mode}, {"byteStride", stride}, {"count", count}});
      const std::string expected =
          "/bufferViews/3/extensions/EXT_meshopt_compression/byteLength: expected at least";
      EXPECT_EQ(refusal(bad.glb()).substr(0, expected.size()), expected) << mode << " " << count;
    }
  }
}

// Each stream may hold what it says, but they are all one.
TEST_F(GltfMeshopt, RefusesStreamsThatRepeatTheSameBytes) {
  GltfBuilder builder;
  builder.add_triangle();
  const std::string zeros(std::size_t(1) << 22, '\0');
  const int number = builder.add_bytes(zeros);
  const GltfBuilder plain = builder;
  compress(builder, plain, 0, 12, "ATTRIBUTES");
  set_stream(builder, number, encode(zeros, 64, "ATTRIBUTES"), 64, "ATTRIBUTES");
  EXPECT_EQ(refusal(builder.glb()), "");
  for (int i = 0; i < 60; ++i) builder.root["bufferViews"].push_back(builder.root["bufferViews"][1]);
  EXPECT_NE(refusal(builder.glb()).find("expected streams that do not repeat the same bytes"),
            std::string::npos);
}

class NightlyGltfMeshopt : public GltfMeshopt {};

TEST_F(GltfMeshopt, StaysWithinTheMemoryLimit) {
  const std::string file = compressed_grid<std::uint16_t>().glb();
  set_memory_limit(1);
  try {
    load(file);
    ADD_FAILURE() << "decompressed beyond the limit";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string_view(error.what()).find("not enough memory: decompressing"), std::string::npos)
        << error.what();
  }
  set_memory_limit(available_memory());
  EXPECT_NO_THROW(load(file));
}

TEST_F(GltfMeshopt, SurvivesFlippedBytes) { flip_bytes(13); }
TEST_F(NightlyGltfMeshopt, SurvivesEveryFlippedByte) { flip_bytes(1); }

TEST_F(GltfMeshopt, RefusesTruncatedStreams) {
  const GltfBuilder good = compressed_grid<std::uint16_t>();
  for (std::size_t view = 0; view < 4; ++view) {
    const std::size_t length = good.root["bufferViews"][view]["extensions"][kExtension]["byteLength"];
    for (std::size_t shorter = 1; shorter < length; shorter += 29) {
      GltfBuilder bad = good;
      bad.root["bufferViews"][view]["extensions"][kExtension]["byteLength"] = shorter;
      EXPECT_TRUE(
          refusal(bad.glb()).starts_with(fmt::format("/bufferViews/{}/extensions/EXT_meshopt", view)));
    }
  }
}

}  // namespace
}  // namespace parian
