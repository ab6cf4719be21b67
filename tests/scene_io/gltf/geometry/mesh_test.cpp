// Meshes: topology, attributes, and what is left out.
#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfMesh : public GltfTest {
 protected:
  Primitive primitive(const GltfBuilder& builder) {
    return load(builder.glb()).meshes.at(0).primitives.at(0);
  }

  std::vector<Triangle> triangles(int mode, std::size_t vertices,
                                  const std::vector<std::uint8_t>& indices = {}) {
    GltfBuilder builder;
    json& mesh = builder.add_mesh({{"POSITION", builder.add(std::vector<float>(3 * vertices), "VEC3")}});
    mesh["mode"] = mode;
    if (!indices.empty()) {
      const int accessor = builder.add(indices, "SCALAR");
      mesh["indices"] = accessor;
    }
    const auto result = primitive(builder).triangles;
    return {result.begin(), result.end()};
  }
};

TEST_F(GltfMesh, ReadsLists) {
  EXPECT_EQ(triangles(4, 6), (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(triangles(4, 4, {0, 1, 2, 2, 1, 3}), (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
}

// The winding of every other triangle is turned, so that all face the same way.
TEST_F(GltfMesh, ReadsStrips) {
  EXPECT_EQ(triangles(5, 5), (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}, {2, 3, 4}}));
  EXPECT_EQ(triangles(5, 4, {3, 2, 1, 0}), (std::vector<Triangle>{{3, 2, 1}, {2, 0, 1}}));
}

TEST_F(GltfMesh, ReadsFans) {
  EXPECT_EQ(triangles(6, 5), (std::vector<Triangle>{{1, 2, 0}, {2, 3, 0}, {3, 4, 0}}));
  EXPECT_EQ(triangles(6, 4, {3, 2, 1, 0}), (std::vector<Triangle>{{2, 1, 3}, {1, 0, 3}}));
}

TEST_F(GltfMesh, RefusesIncompleteTriangles) {
  for (const auto& [mode, vertices] : std::vector<std::pair<int, int>>{{4, 4}, {4, 2}, {5, 2}, {6, 1}}) {
    GltfBuilder builder;
    builder.add_mesh(
        {{"POSITION", builder.add(std::vector<float>(std::size_t(3 * vertices)), "VEC3")}})["mode"] = mode;
    EXPECT_EQ(refusal(builder.glb()).substr(0, 32), "/meshes/0/primitives/0: expected")
        << mode << " " << vertices;
  }
}

TEST_F(GltfMesh, SkipsPointsAndLinesWithOneWarning) {
  GltfBuilder builder;
  builder.add_triangle();
  json& primitives = builder.root["meshes"][0]["primitives"];
  for (const int mode : {0, 1, 2, 3}) {
    json lines = primitives[0];
    lines["mode"] = mode;
    primitives.push_back(lines);
  }
  const Scene scene = load(builder.glb());
  EXPECT_EQ(scene.meshes[0].primitives.size(), 1u);
  EXPECT_EQ(warnings, std::vector<std::string>{path("scene.glb") + ": points and lines are not drawn"});
}

TEST_F(GltfMesh, SkipsPrimitivesWithoutPositions) {
  GltfBuilder builder;
  builder.add_mesh(json::object());
  EXPECT_TRUE(load(builder.glb()).meshes.at(0).primitives.empty());
  EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(GltfMesh, GivesPrimitivesWithoutMaterialTheDefault) {
  GltfBuilder builder;
  builder.add_triangle();
  builder.add_mesh({{"POSITION", 0}});
  builder.root["materials"] = {{{"name", "own"}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}};
  builder.add_mesh({{"POSITION", 0}})["material"] = 0;
  const Scene scene = load(builder.glb());
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.meshes[0].primitives[0].material, 1);
  EXPECT_EQ(scene.meshes[1].primitives[0].material, 1);
  EXPECT_EQ(scene.meshes[2].primitives[0].material, 0);
  Material expected;  // glTF's default is the metallic-roughness material with all its defaults
  expected.name = scene.materials[1].name;
  EXPECT_EQ(scene.materials[1], expected);
  EXPECT_EQ(expected.metallic, 1);
}

TEST_F(GltfMesh, LeavesOutWhatIsNotThere) {
  GltfBuilder builder;
  builder.add_triangle();
  const Primitive p = primitive(builder);
  EXPECT_TRUE(p.normals.empty() && p.tangents.empty() && p.colors.empty() && p.uvs[0].empty() &&
              p.uvs[1].empty());
}

TEST_F(GltfMesh, ReadsBothTextureCoordinateSets) {
  GltfBuilder builder;
  json& mesh = builder.add_triangle();
  const int first = builder.add<float>({0, 0, 1, 0, 0, 1}, "VEC2"),
            second = builder.add<float>({5, 5, 6, 5, 5, 6}, "VEC2");
  mesh["attributes"]["TEXCOORD_0"] = first;
  mesh["attributes"]["TEXCOORD_1"] = second;
  const Primitive p = primitive(builder);
  EXPECT_EQ(p.uvs[0][1], Vec2f(1, 0));
  EXPECT_EQ(p.uvs[1][1], Vec2f(6, 5));
}

TEST_F(GltfMesh, ReadsVertexColours) {
  const auto color = [&](auto values, const char* type, bool normalized) {
    GltfBuilder builder;
    json& mesh = builder.add_triangle();
    const int accessor = builder.add(values, type, normalized);
    mesh["attributes"]["COLOR_0"] = accessor;
    return primitive(builder).colors[1];
  };
  EXPECT_EQ(color(std::vector<float>{0, 0, 0, .25f, .5f, .75f, 0, 0, 0}, "VEC3", false),
            Vec4f(.25f, .5f, .75f, 1));
  EXPECT_EQ(color(std::vector<float>{0, 0, 0, 0, .25f, .5f, .75f, .125f, 0, 0, 0, 0}, "VEC4", false),
            Vec4f(.25f, .5f, .75f, .125f));
  EXPECT_EQ(color(std::vector<std::uint8_t>{0, 0, 0, 51, 0, 255, 0, 0, 0}, "VEC3", true),
            Vec4f(51 / 255.0f, 0, 1, 1));
  EXPECT_EQ(color(std::vector<std::uint16_t>{0, 0, 0, 0, 13107, 0, 65535, 65535, 0, 0, 0, 0}, "VEC4", true),
            Vec4f(13107 / 65535.0f, 0, 1, 1));
}

TEST_F(GltfMesh, ReadsQuantisedGeometry) {
  GltfBuilder builder;
  builder.root["extensionsRequired"] = {"KHR_mesh_quantization"};
  const int positions = builder.add<std::int16_t>({0, 0, 0, 0, 100, 0, 0, 0, 0, 100, -3, 0}, "VEC4");
  builder.root["accessors"][0].update({{"type", "VEC3"}});
  builder.root["bufferViews"][0]["byteStride"] = 8;
  const int normals = builder.add<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, "VEC4", true);
  builder.root["accessors"][1].update({{"type", "VEC3"}});
  builder.root["bufferViews"][1]["byteStride"] = 4;
  builder.add_mesh({{"POSITION", positions}, {"NORMAL", normals}});
  const Primitive p = primitive(builder);
  EXPECT_EQ(p.positions[2], Vec3f(0, 100, -3));
  EXPECT_EQ(p.normals[2], Vec3f(0, 0, 1));
  EXPECT_TRUE(warnings.empty());
}

TEST_F(GltfMesh, MakesNormalsUnit) {
  GltfBuilder builder;
  json& mesh = builder.add_triangle();
  const int accessor = builder.add<float>({0, 3, 4, 1e-30f, 0, 0, 0, 0, -1e30f}, "VEC3");
  mesh["attributes"]["NORMAL"] = accessor;
  const Primitive p = primitive(builder);
  EXPECT_EQ(p.normals[0], Vec3f(0, .6f, .8f));
  EXPECT_EQ(p.normals[1], Vec3f(1, 0, 0));
  EXPECT_EQ(p.normals[2], Vec3f(0, 0, -1));
}

TEST_F(GltfMesh, ReplacesZeroNormalsByThoseOfATriangle) {
  GltfBuilder builder;
  // Counter-clockwise seen from +y, and a vertex that no triangle uses.
  json& mesh =
      builder.add_mesh({{"POSITION", builder.add<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 5, 5, 5}, "VEC3")}});
  const int indices = builder.add<std::uint8_t>({0, 1, 2}, "SCALAR");
  const int normals = builder.add<float>({0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  mesh["indices"] = indices;
  mesh["attributes"]["NORMAL"] = normals;
  const Primitive p = primitive(builder);
  EXPECT_EQ(p.normals[0], Vec3f(0, 1, 0));
  EXPECT_EQ(p.normals[1], Vec3f(1, 0, 0));
  EXPECT_EQ(p.normals[2], Vec3f(0, 1, 0));
  EXPECT_FLOAT_EQ(p.normals[3].length(), 1);
}

TEST_F(GltfMesh, ReadsTangents) {
  GltfBuilder builder;
  json& mesh = builder.add_triangle();
  const int tangents = builder.add<float>({1, 0, 0, 1, 0, 2, 0, -1, 0, 0, 0, .5f}, "VEC4");
  mesh["attributes"]["TANGENT"] = tangents;
  EXPECT_TRUE(primitive(builder).tangents.empty());  // no normals: no frame for them
  const int normals = builder.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  builder.root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
  const Primitive p = primitive(builder);
  EXPECT_EQ(p.tangents[0], Vec4f(1, 0, 0, 1));
  EXPECT_EQ(p.tangents[1], Vec4f(0, 1, 0, -1));
  EXPECT_FLOAT_EQ(Vec3f(p.tangents[2].x, p.tangents[2].y, p.tangents[2].z).length(), 1);  // had length 0
  EXPECT_FLOAT_EQ(p.tangents[2].z, 0);
  EXPECT_EQ(p.tangents[2].w, 1);
}

TEST_F(GltfMesh, RefusesAttributesOfTheWrongType) {
  struct Case {
    const char* attribute;
    std::function<int(GltfBuilder&)> add;
  };
  const std::vector<Case> cases = {
      {"POSITION",
       [](GltfBuilder& b) {
         return b.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
       }},
      {"POSITION",
       [](GltfBuilder& b) {
         return b.add<std::uint32_t>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
       }},
      {"NORMAL",
       [](GltfBuilder& b) {
         return b.add<std::int8_t>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
       }},
      {"TEXCOORD_0",
       [](GltfBuilder& b) {
         return b.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC3");
       }},
      {"COLOR_0",
       [](GltfBuilder& b) {
         return b.add<std::uint8_t>({0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC3");
       }},
      {"NORMAL",
       [](GltfBuilder& b) {
         return b.add<float>({0, 0, 1, 0, 0, 1}, "VEC3");
       }},  // too few
  };
  for (const Case& c : cases) {
    GltfBuilder builder;
    json& mesh = builder.add_triangle();
    const int accessor = c.add(builder);
    mesh["attributes"][c.attribute] = accessor;
    const std::string expected = fmt::format("/meshes/0/primitives/0/attributes/{}: expected", c.attribute);
    EXPECT_EQ(refusal(builder.glb()).substr(0, expected.size()), expected);
  }
}

}  // namespace
}  // namespace parian
