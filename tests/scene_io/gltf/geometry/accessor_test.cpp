// Accessors: however the file stores numbers, the scene holds the same ones.
#include <gtest/gtest.h>

#include <limits>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfAccessor : public GltfTest {
 protected:
  Primitive primitive(const GltfBuilder& builder) {
    return load(builder.glb()).meshes.at(0).primitives.at(0);
  }

  /// The texture coordinates of a triangle with these, stored as T.
  template <class T>
  std::vector<Vec2f> coordinates(const std::vector<T>& stored, bool normalized) {
    GltfBuilder builder;
    json& mesh = builder.add_triangle();
    const int accessor = builder.add<T>(stored, "VEC2", normalized);
    mesh["attributes"]["TEXCOORD_0"] = accessor;
    const auto uvs = primitive(builder).uvs[0];
    return {uvs.begin(), uvs.end()};
  }
};

TEST_F(GltfAccessor, DecodesEveryComponentType) {
  const std::vector<Vec2f> plain = {{0, 1}, {2, 3}, {4, 5}};
  EXPECT_EQ(coordinates<std::int8_t>({0, 1, 2, 3, 4, 5}, false), plain);
  EXPECT_EQ(coordinates<std::uint8_t>({0, 1, 2, 3, 4, 5}, false), plain);
  EXPECT_EQ(coordinates<std::int16_t>({0, 1, 2, 3, 4, 5}, false), plain);
  EXPECT_EQ(coordinates<std::uint16_t>({0, 1, 2, 3, 4, 5}, false), plain);
  EXPECT_EQ(coordinates<float>({0, 1, 2, 3, 4, 5}, false), plain);
}

TEST_F(GltfAccessor, NormalisesIntegers) {
  EXPECT_EQ(coordinates<std::uint8_t>({0, 255, 51, 0, 0, 0}, true)[0], Vec2f(0, 1));
  EXPECT_EQ(coordinates<std::uint8_t>({0, 255, 51, 0, 0, 0}, true)[1].x, 51 / 255.0f);
  EXPECT_EQ(coordinates<std::uint16_t>({0, 65535, 13107, 0, 0, 0}, true)[0], Vec2f(0, 1));
  // Signed: both -max and -max - 1 are -1.
  EXPECT_EQ(coordinates<std::int8_t>({127, -127, -128, 0, 0, 0}, true)[0], Vec2f(1, -1));
  EXPECT_EQ(coordinates<std::int8_t>({127, -127, -128, 0, 0, 0}, true)[1].x, -1);
  EXPECT_EQ(coordinates<std::int16_t>({32767, -32767, -32768, 0, 0, 0}, true)[0], Vec2f(1, -1));
}

TEST_F(GltfAccessor, ReadsInterleavedAttributes) {
  GltfBuilder builder;
  // Position and texture coordinate, 20 bytes a vertex, after 8 bytes of something else.
  const int view = builder.add_view<float>({9, 9, 0, 0, 0, .1f, .2f, 1, 0, 0, .3f, .4f, 0, 1, 0, .5f, .6f});
  builder.root["bufferViews"][0]["byteStride"] = 20;
  const auto accessor = [&](int offset, const char* type) {
    return json{
        {"bufferView", view}, {"byteOffset", offset}, {"componentType", 5126}, {"count", 3}, {"type", type}};
  };
  builder.root["accessors"] = {accessor(8, "VEC3"), accessor(20, "VEC2")};
  builder.add_mesh({{"POSITION", 0}, {"TEXCOORD_0", 1}});
  const Primitive p = primitive(builder);
  EXPECT_EQ(p.positions[2], Vec3f(0, 1, 0));
  EXPECT_EQ(p.uvs[0][0], Vec2f(.1f, .2f));
  EXPECT_EQ(p.uvs[0][2], Vec2f(.5f, .6f));
}

TEST_F(GltfAccessor, ReadsUnalignedData) {
  GltfBuilder builder;
  builder.add_triangle();
  builder.binary.insert(0, 1, 'x');
  builder.root["bufferViews"][0]["byteOffset"] = 1;
  EXPECT_EQ(primitive(builder).positions[1], Vec3f(1, 0, 0));
}

TEST_F(GltfAccessor, ReplacesSparseElements) {
  GltfBuilder builder;
  builder.add_triangle();
  const int indices = builder.add_view<std::uint16_t>({0, 2});
  const int values = builder.add_view<float>({7, 7, 7, 8, 8, 8});
  builder.root["accessors"][0]["sparse"] = {{"count", 2},
                                            {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                                            {"values", {{"bufferView", values}}}};
  Primitive p = primitive(builder);
  EXPECT_EQ(p.positions[0], Vec3f(7));
  EXPECT_EQ(p.positions[1], Vec3f(1, 0, 0));
  EXPECT_EQ(p.positions[2], Vec3f(8));

  // Without a bufferView what is not replaced is zero.
  builder.root["accessors"][0].erase("bufferView");
  p = primitive(builder);
  EXPECT_EQ(p.positions[1], Vec3f(0));
  EXPECT_EQ(p.positions[2], Vec3f(8));
}

TEST_F(GltfAccessor, ReplacesSparseIndices) {
  GltfBuilder builder;
  json& mesh = builder.add_triangle();
  const int accessor = builder.add<std::uint16_t>({0, 1, 1}, "SCALAR");
  mesh["indices"] = accessor;
  const int indices = builder.add_view<std::uint8_t>({2});
  const int values = builder.add_view<std::uint16_t>({2});
  builder.root["accessors"][std::size_t(accessor)]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  EXPECT_EQ(primitive(builder).triangles[0], (Triangle{0, 1, 2}));
}

TEST_F(GltfAccessor, ReadsEveryIndexType) {
  const auto triangle = [&](auto tag) {
    GltfBuilder builder;
    json& mesh = builder.add_triangle();
    const int accessor = builder.add<decltype(tag)>({2, 0, 1}, "SCALAR");
    mesh["indices"] = accessor;
    return primitive(builder).triangles[0];
  };
  EXPECT_EQ(triangle(std::uint8_t()), (Triangle{2, 0, 1}));
  EXPECT_EQ(triangle(std::uint16_t()), (Triangle{2, 0, 1}));
  EXPECT_EQ(triangle(std::uint32_t()), (Triangle{2, 0, 1}));
}

TEST_F(GltfAccessor, SharesArraysBetweenPrimitives) {
  GltfBuilder builder;
  builder.add_triangle();
  builder.add_mesh({{"POSITION", 0}});
  const Scene scene = load(builder.glb());
  EXPECT_EQ(scene.meshes[0].primitives[0].positions.data(), scene.meshes[1].primitives[0].positions.data());
}

// More than one chunk of the parallel decoder, and the chunk border in a triangle.
TEST_F(GltfAccessor, DecodesLongArrays) {
  constexpr std::uint32_t kVertices = 3 * 100'000;
  std::vector<float> positions(3 * kVertices);
  std::vector<std::uint32_t> indices(kVertices);
  for (std::uint32_t i = 0; i < kVertices; ++i) {
    positions[3 * i] = float(i);
    indices[i] = kVertices - 1 - i;
  }
  GltfBuilder builder;
  json& mesh = builder.add_mesh({{"POSITION", builder.add(positions, "VEC3")}});
  const int accessor = builder.add(indices, "SCALAR");
  mesh["indices"] = accessor;
  const Primitive p = primitive(builder);
  ASSERT_EQ(p.triangles.size(), kVertices / 3);
  for (std::uint32_t i = 0; i < kVertices; ++i) {
    ASSERT_EQ(p.positions[i].x, float(i));
    ASSERT_EQ(p.triangles[i / 3][i % 3], kVertices - 1 - i);
  }
}

TEST_F(GltfAccessor, RefusesNumbersThatAreNot) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    GltfBuilder builder;
    builder.add_mesh({{"POSITION", builder.add<float>({0, 0, 0, 1, 0, 0, 0, bad, 0}, "VEC3")}});
    EXPECT_EQ(refusal(builder.glb()),
              fmt::format("/accessors/0: expected finite numbers, element 2 holds {}", bad));
  }
}

TEST_F(GltfAccessor, RefusesIndicesBeyondTheVertices) {
  GltfBuilder builder;
  json& mesh = builder.add_triangle();
  const int accessor = builder.add<std::uint16_t>({0, 3, 1}, "SCALAR");
  mesh["indices"] = accessor;
  EXPECT_EQ(refusal(builder.glb()),
            "/accessors/1: expected indices below 3, the number of vertices; element 1 is 3");
}

TEST_F(GltfAccessor, RefusesRestartIndices) {
  std::vector<float> positions(3 * 66'000);
  GltfBuilder builder;
  json& mesh = builder.add_mesh({{"POSITION", builder.add(positions, "VEC3")}});
  const int accessor = builder.add<std::uint16_t>({0, 1, 65535}, "SCALAR");
  mesh["indices"] = accessor;
  EXPECT_EQ(refusal(builder.glb()),
            "/accessors/1: expected no index 65535, which is the primitive restart value");
}

TEST_F(GltfAccessor, RefusesSparseIndicesThatDoNotRise) {
  GltfBuilder builder;
  builder.add_triangle();
  const int values = builder.add_view<float>({7, 7, 7, 8, 8, 8});
  for (const auto& positions : std::vector<std::vector<std::uint8_t>>{{1, 1}, {2, 0}, {0, 3}}) {
    const int indices = builder.add_view(positions);
    builder.root["accessors"][0]["sparse"] = {{"count", 2},
                                              {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                              {"values", {{"bufferView", values}}}};
    EXPECT_EQ(refusal(builder.glb()).substr(0, 28), "/accessors/0/sparse/indices:");
  }
}

// Each of these claims far more than the file holds: the memory must not be taken.
TEST_F(GltfAccessor, RefusesAbsurdClaims) {
  GltfBuilder zeros;
  zeros.root["accessors"] = {{{"componentType", 5126}, {"count", 1e9}, {"type", "VEC3"}}};
  zeros.add_mesh({{"POSITION", 0}});
  EXPECT_EQ(refusal(zeros.glb()).substr(0, 19), "/accessors/0/count:");

  GltfBuilder counted;
  counted.add_triangle();
  for (const double count : {4.0, 1e9, 1.5e18, 6148914691236517206.0}) {
    counted.root["accessors"][0]["count"] = count;
    EXPECT_EQ(refusal(counted.glb()).substr(0, 19), "/accessors/0/count:") << count;
  }

  // 2000 accessors over the same 600 kB of zeros: 4.8 GB decoded.
  GltfBuilder overlapping;
  overlapping.add_mesh({{"POSITION", overlapping.add(std::vector<float>(3 * 50'001), "VEC3")}});
  json primitives = json::array();
  for (int i = 0; i < 2'000; ++i) {
    json accessor = overlapping.root["accessors"][0];
    accessor["componentType"] = 5121;
    accessor["count"] = 200'001;
    overlapping.root["accessors"].push_back(accessor);
    primitives.push_back({{"attributes", {{"POSITION", i + 1}}}});
  }
  overlapping.root["meshes"][0]["primitives"] = primitives;
  EXPECT_NE(refusal(overlapping.glb()).find("repeat the same bytes"), std::string::npos);
}

// Packed floats and 32-bit indices are read where the file lies; what is interleaved, short or not aligned is
// copied. Caught: a copy of what could be shared, a view of what cannot.
TEST_F(GltfAccessor, SharesWithTheFileWhatLiesAsItIsRead) {
  const std::vector<float> points{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<std::uint32_t> corners{2, 0, 1};
  const auto mesh_with = [&](const auto& change) {
    GltfBuilder builder;
    const int positions = builder.add(points, "VEC3");
    json& primitive = builder.add_mesh({{"POSITION", positions}});
    primitive["indices"] = builder.add(corners, "SCALAR");
    change(builder);
    return load(builder.glb()).meshes.at(0).primitives.at(0);
  };
  const auto expect_values = [&](const Primitive& p) {
    ASSERT_EQ(p.positions.size(), 3u);
    EXPECT_EQ(p.positions[1], Vec3f(1, 0, 0));
    EXPECT_EQ(p.triangles[0], (Triangle{2, 0, 1}));
    EXPECT_TRUE(p.positions.padded());
  };
  const Primitive shared = mesh_with([](GltfBuilder&) {});
  expect_values(shared);
  const auto* const first = reinterpret_cast<const char*>(shared.positions.data());
  EXPECT_EQ(reinterpret_cast<const char*>(shared.triangles.data()) - first, 9 * 4);  // as in the file

  const Primitive interleaved = mesh_with([&](GltfBuilder& builder) {
    std::vector<float> wide;
    for (int i = 0; i < 3; ++i)
      wide.insert(wide.end(), {points[3 * i], points[3 * i + 1], points[3 * i + 2], 7});
    builder.root["accessors"][0]["bufferView"] = builder.add_view(wide);
    builder.root["bufferViews"].back()["byteStride"] = 16;
  });
  expect_values(interleaved);
  const Primitive shorter = mesh_with([&](GltfBuilder& builder) {
    builder.root["meshes"][0]["primitives"][0]["indices"] =
        builder.add(std::vector<std::uint16_t>{2, 0, 1}, "SCALAR");
  });
  expect_values(shorter);
  for (const Primitive* p : {&interleaved, &shorter})
    EXPECT_NE(reinterpret_cast<const char*>(p->triangles.data()) -
                  reinterpret_cast<const char*>(p->positions.data()),
              9 * 4);
}

}  // namespace
}  // namespace parian
