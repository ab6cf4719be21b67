// KHR_draco_mesh_compression: what is decoded is what was encoded, and broken streams are refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "renderer/base/memory.h"
#include "tests/scene_io/support/draco_builder.h"
#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

constexpr const char* kExtension = "KHR_draco_mesh_compression";
constexpr std::uint32_t kSide = 7;  // of the grid, in vertices
constexpr std::uint32_t kVertices = kSide * kSide;

/// A hilly square with everything that a primitive may have.
struct Grid {
  std::vector<float> positions, normals, tangents, uvs;
  std::vector<std::uint8_t> colors;
  std::vector<std::uint16_t> second_uvs;
  std::vector<std::uint32_t> corners;

  Grid() {
    for (std::uint32_t i = 0; i < kVertices; ++i) {
      const float x = float(i % kSide), y = float(i / kSide), h = 0.6f + 0.01f * x, l = std::sqrt(1 - h * h);
      for (const float p : {x, y, std::sin(x) * std::cos(0.3f * y)}) positions.push_back(p);
      for (const float n : {0.0f, h, l}) normals.push_back(n);
      for (const float t : {1.0f, 0.0f, 0.0f, i % 2 == 0 ? 1.0f : -1.0f}) tangents.push_back(t);
      for (const float u : {x / kSide, y / kSide}) uvs.push_back(u);
      for (std::uint32_t c = 0; c < 4; ++c) colors.push_back(std::uint8_t(i * 5 + c));
      for (const std::uint32_t u : {i * 1000, 65535 - i}) second_uvs.push_back(std::uint16_t(u));
      if (i % kSide == kSide - 1 || i / kSide == kSide - 1) continue;
      for (const std::uint32_t c : {i, i + 1, i + kSide, i + kSide, i + 1, i + kSide + 1})
        corners.push_back(c);
    }
  }

  /// The ids rise backwards, so that they are not the attributes' numbers.
  DracoBuilder draco() const {
    using draco::GeometryAttribute;
    DracoBuilder builder(corners);
    builder.add(GeometryAttribute::POSITION, 15, positions, 3);
    builder.add(GeometryAttribute::NORMAL, 14, normals, 3);
    builder.add(GeometryAttribute::GENERIC, 13, tangents, 4);
    builder.add(GeometryAttribute::TEX_COORD, 12, uvs, 2);
    builder.add(GeometryAttribute::COLOR, 11, colors, 4);
    builder.add(GeometryAttribute::GENERIC, 10, second_uvs, 2);
    return builder;
  }

  GltfBuilder gltf() const {
    GltfBuilder builder;
    json attributes;
    attributes["POSITION"] = builder.add(positions, "VEC3");
    attributes["NORMAL"] = builder.add(normals, "VEC3");
    attributes["TANGENT"] = builder.add(tangents, "VEC4");
    attributes["TEXCOORD_0"] = builder.add(uvs, "VEC2");
    attributes["COLOR_0"] = builder.add(colors, "VEC4", true);
    attributes["TEXCOORD_1"] = builder.add(second_uvs, "VEC2", true);
    const int indices = builder.add(std::vector<std::uint8_t>(corners.begin(), corners.end()), "SCALAR");
    builder.add_mesh(attributes)["indices"] = indices;
    builder.root["nodes"] = {{{"mesh", 0}}};
    return builder;
  }
};

json& primitive(GltfBuilder& builder) { return builder.root["meshes"][0]["primitives"][0]; }
json& extension(GltfBuilder& builder) { return primitive(builder)["extensions"][kExtension]; }

/// The same with all of it in the stream, and in the stream alone.
GltfBuilder compress(GltfBuilder builder, const std::string& stream) {
  builder.binary.clear();
  builder.root.erase("bufferViews");
  for (json& accessor : builder.root["accessors"]) accessor.erase("bufferView");
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) builder.root[list] = {kExtension};
  extension(builder) = {{"bufferView", builder.add_bytes(stream)}, {"attributes", json::object()}};
  for (const auto& [name, accessor] : primitive(builder)["attributes"].items()) {
    extension(builder)["attributes"][name] = 15 - accessor.get<int>();
  }
  return builder;
}

class GltfDraco : public GltfTest {
 protected:
  Grid grid_;
  GltfBuilder plain_ = grid_.gltf();
  GltfBuilder builder_ = compress(plain_, grid_.draco().sequential());
};

TEST_F(GltfDraco, ReadsWhatItReadsUncompressed) {
  EXPECT_EQ(load(builder_.glb()), load(plain_.glb()));
  EXPECT_EQ(warnings, std::vector<std::string>());
}

TEST_F(GltfDraco, ReadsIndicesOfEveryType) {
  const Scene scene = load(plain_.glb());
  for (const int type : {5121, 5123, 5125}) {
    builder_.root["accessors"][6]["componentType"] = type;
    EXPECT_EQ(load(builder_.glb()), scene);
  }
}

/// A triangle as its corners' values, turned so that the least is first.
using Corner = std::array<float, 8>;
std::multiset<std::array<Corner, 3>> triangles_of(const Primitive& p) {
  std::multiset<std::array<Corner, 3>> result;
  for (const Triangle& t : p.triangles) {
    std::array<Corner, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t v = t[c];
      // To a grid that is coarser than the quantization, and not on its half-way values.
      const auto round = [](float x) { return std::round(x * 50 + 0.25f); };
      corners[c] = {
          round(p.positions[v].x), round(p.positions[v].y), round(p.uvs[0][v].x), round(p.uvs[0][v].y),
          p.colors[v].x,           p.colors[v].w,           p.uvs[1][v].x,        p.uvs[1][v].y};
    }
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    result.insert(corners);
  }
  return result;
}

TEST_F(GltfDraco, ReadsEveryMethodOfTheEncoder) {
  const Primitive expected = load(plain_.glb()).meshes[0].primitives[0];
  for (const int speed : {0, 1, 5, 7, 10}) {
    const GltfBuilder builder = compress(plain_, grid_.draco().edgebreaker(16, speed));
    const Primitive p = load(builder.glb()).meshes[0].primitives[0];
    EXPECT_EQ(triangles_of(p), triangles_of(expected)) << speed;
    for (std::size_t v = 0; v < p.positions.size(); ++v) {
      const Vec3f& at = p.positions[v];
      EXPECT_NEAR(at.z, std::sin(at.x) * std::cos(0.3f * at.y), 1e-3f);
      EXPECT_NEAR(p.normals[v].y, 0.6f + 0.01f * at.x, 1e-3f);
      EXPECT_NEAR(p.normals[v].length(), 1, 1e-5f);
      EXPECT_NEAR(p.tangents[v].x, 1, 1e-3f);
    }
  }
}

// A seam: two vertices of the mesh at one place with different uvs.
TEST_F(GltfDraco, ReadsSeams) {
  const std::vector<std::uint32_t> corners = {0, 1, 2, 3, 5, 4};
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
  const std::vector<float> uvs = {0, 0, 0.5f, 0, 0, 0.5f, 1, 0, 1, 0.5f, 0.5f, 0.5f};
  DracoBuilder draco(corners);
  draco.add(draco::GeometryAttribute::POSITION, 15, positions, 3);
  draco.add(draco::GeometryAttribute::TEX_COORD, 14, uvs, 2);
  draco.mesh->DeduplicateAttributeValues();
  GltfBuilder plain;
  json& mesh = plain.add_mesh({{"POSITION", plain.add(positions, "VEC3")}});
  mesh["attributes"]["TEXCOORD_0"] = plain.add(uvs, "VEC2");
  mesh["indices"] = plain.add(corners, "SCALAR");
  const Primitive p = load(compress(plain, draco.edgebreaker(12, 0)).glb()).meshes[0].primitives[0];
  ASSERT_EQ(p.positions.size(), 6u);
  float sum = 0;
  for (const Triangle& t : p.triangles) {
    for (const std::uint32_t v : t) sum += p.uvs[0][v].x * (p.positions[v].x + 2 * p.positions[v].y + 1);
  }
  EXPECT_NEAR(sum, 1 + 2 + 3 + 2, 0.01f);
}

// Whatever the strip would be, its triangles are those of the stream.
TEST_F(GltfDraco, ReadsStrips) {
  const Scene scene = load(plain_.glb());
  primitive(builder_)["mode"] = 5;
  for (const std::size_t count : {grid_.corners.size() / 3 + 2, grid_.corners.size(), std::size_t(1000)}) {
    builder_.root["accessors"][6]["count"] = count;
    EXPECT_EQ(load(builder_.glb()), scene);
  }
}

TEST_F(GltfDraco, ReadsTheTrianglesOfAPrimitiveWithoutIndices) {
  primitive(builder_).erase("indices");
  EXPECT_EQ(load(builder_.glb()), load(plain_.glb()));
}

TEST_F(GltfDraco, ReadsPlainAttributesBesides) {
  const int plain = builder_.add(grid_.uvs, "VEC2");
  primitive(builder_)["attributes"]["TEXCOORD_1"] = plain;
  extension(builder_)["attributes"].erase("TEXCOORD_1");
  const Primitive p = load(builder_.glb()).meshes[0].primitives[0];
  EXPECT_EQ(p.uvs[1], p.uvs[0]);
}

TEST_F(GltfDraco, PrefersTheStreamToWhatElseIsThere) {
  const Scene scene = load(plain_.glb());
  const int other = builder_.add_view(std::vector<float>(3 * kVertices));
  builder_.root["accessors"][0].update({{"bufferView", other}, {"byteOffset", 4}});
  builder_.root["accessors"][6].update({{"bufferView", other}, {"byteOffset", 4}});
  EXPECT_EQ(load(builder_.glb()), scene);
}

TEST_F(GltfDraco, DecodesAStreamOnceForAllItsPrimitives) {
  json second = primitive(builder_);
  second["attributes"].erase("COLOR_0");
  second["extensions"][kExtension]["attributes"].erase("COLOR_0");
  builder_.root["meshes"][0]["primitives"].push_back(second);
  const auto primitives = load(builder_.glb()).meshes[0].primitives;
  ASSERT_EQ(primitives.size(), 2u);
  EXPECT_EQ(primitives[0].positions.data(), primitives[1].positions.data());
  EXPECT_EQ(primitives[0].triangles.data(), primitives[1].triangles.data());
  EXPECT_TRUE(primitives[1].colors.empty());
}

TEST_F(GltfDraco, StaysWithinTheMemoryLimit) {
  set_memory_limit(1);
  try {
    load(builder_.glb());
    ADD_FAILURE() << "decompressed beyond the limit";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string_view(error.what()).find("not enough memory: decompressing"), std::string::npos)
        << error.what();
  }
  set_memory_limit(available_memory());
  EXPECT_NO_THROW(load(builder_.glb()));
}

TEST_F(GltfDraco, RefusesAnAccessorOfTwoStreams) {
  json second = primitive(builder_);
  const int stream = builder_.add_bytes(grid_.draco().sequential());
  second["extensions"][kExtension]["bufferView"] = stream;
  builder_.root["meshes"][0]["primitives"].push_back(second);
  EXPECT_TRUE(
      refusal(builder_.glb())
          .starts_with("/meshes/0/primitives/1/attributes/COLOR_0: expected an accessor that no other"));
}

struct Mutation {
  std::string place;
  json value;
  std::string expected = place + ": expected";
};

TEST_F(GltfDraco, RefusesWhatDoesNotMatchTheStream) {
  const std::string p = "/meshes/0/primitives/0", e = p + "/extensions/KHR_draco_mesh_compression";
  const std::vector<Mutation> mutations = {
      {e, 1},
      {e + "/bufferView", 1},
      {e + "/bufferView", nullptr},
      {e + "/attributes", 1, e + "/attributes: expected an object of integers"},
      {e + "/attributes/POSITION", -1},
      {e + "/attributes/POSITION", "0"},
      {e + "/attributes/TEXCOORD_5", 1, e + "/attributes/TEXCOORD_5: expected the name of an attribute"},
      {e + "/attributes/POSITION", 99,
       p + "/attributes/POSITION: expected the stream to have an attribute 99"},
      {e + "/attributes/POSITION", 12,
       p + "/attributes/POSITION: expected an accessor of 2 components of type 5126"},
      {p + "/mode", 6, p + "/mode: expected 4 or 5"},
      {p + "/mode", 1, p + "/mode: expected 4 or 5"},
      {"/accessors/0/count", 48, p + "/attributes/POSITION: expected an accessor of 49 elements"},
      {"/accessors/0/count", 4294967295, p + "/attributes/POSITION: expected an accessor of 49 elements"},
      {"/accessors/4/componentType", 5123,
       p + "/attributes/COLOR_0: expected an accessor of 4 components of type 5121"},
      {"/accessors/4/type", "VEC3",
       p + "/attributes/COLOR_0: expected an accessor of 4 components of type 5121"},
      {"/accessors/6/count", 219, p + "/indices: expected an accessor of 216 indices"},
      {"/accessors/6/componentType", 5126, p + "/indices: expected an accessor of SCALAR, unsigned integers"},
      {"/accessors/6/type", "VEC2", p + "/indices: expected an accessor of SCALAR, unsigned integers"},
  };
  for (const Mutation& mutation : mutations) {
    GltfBuilder bad = builder_;
    bad.root[json::json_pointer(mutation.place)] = mutation.value;
    const std::string message = refusal(bad.glb());
    EXPECT_EQ(message.substr(0, mutation.expected.size()), mutation.expected)
        << mutation.place << " = " << mutation.value << ": " << message;
  }
}

TEST_F(GltfDraco, RefusesIndicesTooNarrowForTheVertices) {
  Grid large;
  large.corners = {0, 1, 299};
  large.positions.resize(900);
  DracoBuilder draco(large.corners);
  draco.add(draco::GeometryAttribute::POSITION, 15, large.positions, 3);
  GltfBuilder plain;
  plain.add_mesh({{"POSITION", plain.add(large.positions, "VEC3")}})["indices"] = 1;
  plain.add(std::vector<std::uint8_t>(3), "SCALAR");
  // The sequential decoder of some versions wants three vertices a triangle at most.
  for (int i = 0; i < 99; ++i) large.corners.insert(large.corners.end(), {0, 1, 2});
  DracoBuilder whole(large.corners);
  whole.add(draco::GeometryAttribute::POSITION, 15, large.positions, 3);
  plain.root["accessors"][1]["count"] = 300;
  const GltfBuilder bad = compress(plain, whole.sequential());
  EXPECT_TRUE(
      refusal(bad.glb()).starts_with("/meshes/0/primitives/0/indices: expected indices of a type for"));
}

TEST_F(GltfDraco, RefusesStreamsOfOtherKinds) {
  const std::string where =
      "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: expected a Draco stream";
  const auto with_byte = [&](std::size_t place, char value) {
    GltfBuilder bad = builder_;
    bad.binary[place] = value;
    return refusal(bad.glb());
  };
  EXPECT_EQ(with_byte(0, 'X'), where);
  EXPECT_EQ(with_byte(6, 1), where + " of version 2.2, not 2.1");
  EXPECT_EQ(with_byte(7, 0), where + " of a triangle mesh");
}

/// The message for a stream that stands in place of the grid's, its count of triangles as `indices` say.
class GltfDracoBroken : public GltfDraco {
 protected:
  std::string refusal_of(const std::string& stream, const GltfBuilder& builder) {
    GltfBuilder bad = builder;
    bad.binary = stream;
    bad.root["bufferViews"][0]["byteLength"] = stream.size();
    return refusal(bad.glb());
  }

  /// Every so-maniest byte changed, and all after it cut off: any exception but InputError ends the test.
  void break_streams(std::size_t step) {
    for (const std::string& stream :
         {grid_.draco().sequential(), grid_.draco().edgebreaker(11, 0), grid_.draco().edgebreaker(11, 7)}) {
      const GltfBuilder good = compress(plain_, stream);
      ASSERT_EQ(refusal_of(stream, good), "");
      std::size_t refused = 0;
      for (std::size_t i = 0; i < stream.size(); i += step) {
        for (const int mask : {1 << i % 8, 0xFF}) {
          std::string bad = stream;
          bad[i] = char(bad[i] ^ mask);
          refused += !refusal_of(bad, good).empty();
        }
        std::string claim = stream;  // as much as a number can, which may take seconds
        if (step == 1) refused += !refusal_of(claim.replace(i, 4, "\xFF\xFF\xFF\x7F"), good).empty();
        EXPECT_NE(refusal_of(stream.substr(0, std::max<std::size_t>(i, 1)), good), "") << i;
      }
      EXPECT_GT(refused, stream.size() / step / 10);
    }
  }

  static std::string varint(std::uint64_t value) {
    std::string bytes;
    for (; value > 127; value >>= 7) bytes += char((value & 127) | 128);
    return bytes + char(value);
  }
};

class NightlyGltfDracoBroken : public GltfDracoBroken {};

TEST_F(GltfDracoBroken, SurvivesFlippedBytesAndTruncation) { break_streams(11); }
TEST_F(NightlyGltfDracoBroken, SurvivesEveryFlippedByteAndTruncation) { break_streams(1); }

// Counts that the accessors claim as well: only what a stream of some length can honestly be is allocated.
TEST_F(GltfDracoBroken, RefusesCountsThatNoStreamOfThatLengthHolds) {
  primitive(builder_)["attributes"] = {{"POSITION", 0}};
  extension(builder_)["attributes"] = {{"POSITION", 15}};
  const std::string header = std::string("DRACO\x02\x02\x01", 8);
  const std::string where = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression: expected";
  for (const std::uint64_t triangles :
       {1'000'000u, 715'827'882u, 1'431'655'765u, 2'147'483'648u, 4'294'967'295u}) {
    builder_.root["accessors"][0]["count"] = triangles;
    builder_.root["accessors"][6].update({{"count", 3 * triangles}, {"componentType", 5125}});
    const std::string rest(200, '\1');
    const std::string edgebreaker = header + std::string("\1\0\0\0", 4) + varint(triangles / 2) +
                                    varint(triangles) + '\0' + varint(triangles) + varint(0) + rest;
    EXPECT_EQ(refusal_of(edgebreaker, builder_).substr(0, where.size()), where) << triangles;
    const std::string sequential =
        header + std::string("\0\0\0", 3) + varint(triangles) + varint(triangles) + rest;
    EXPECT_EQ(refusal_of(sequential, builder_).substr(0, where.size()), where) << triangles;
  }
}

// Points that no triangle uses take no bytes of the stream.
TEST_F(GltfDracoBroken, RefusesPointsThatNoStreamOfThatLengthHolds) {
  std::string stream = grid_.draco().sequential();
  const std::size_t place = 12;  // after the header and the count of triangles, 72
  ASSERT_EQ(stream[place], char(kVertices));
  for (const std::uint64_t points : {216u, 100'000'000u, 2'147'483'648u, 4'294'967'295u}) {
    const std::string bad = stream.substr(0, place) + varint(points) + stream.substr(place + 1);
    for (json& accessor : builder_.root["accessors"]) {
      if (accessor["type"] != "SCALAR") accessor["count"] = points;
    }
    EXPECT_NE(refusal_of(bad, builder_), "") << points;
  }
}

}  // namespace
}  // namespace parian
