// Morph targets: whose weights count, what they move, and what stays shared.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfMorph : public GltfTest {
 protected:
  /// A triangle at z = 0 with a target that moves its vertices by 1, 2 and 3 along z.
  void SetUp() override {
    GltfTest::SetUp();
    builder.add_triangle();
    rise = builder.add<float>({0, 0, 1, 0, 0, 2, 0, 0, 3}, "VEC3");
    primitive()["targets"] = {{{"POSITION", rise}}};
    builder.root["nodes"] = {{{"mesh", 0}}};
  }

  json& primitive() { return builder.root["meshes"][0]["primitives"][0]; }
  json& node() { return builder.root["nodes"][0]; }

  /// Gives the primitive an attribute, and its only target the deltas.
  void add_attribute(const char* name, int accessor, int deltas) {
    primitive()["attributes"][name] = accessor;
    primitive()["targets"][0][name] = deltas;
  }

  /// The mesh that node 0 draws.
  Primitive drawn() {
    const Scene scene = load(builder.glb());
    return scene.meshes.at(std::size_t(scene.nodes.at(0).mesh)).primitives.at(0);
  }

  void weigh(float weight) { builder.root["meshes"][0]["weights"] = {weight}; }

  GltfBuilder builder;
  int rise = 0;
};

TEST_F(GltfMorph, WeightsComeFromAnimationNodeAndMesh) {
  EXPECT_EQ(drawn().positions[2], Vec3f(0, 1, 0));
  weigh(0.5f);
  EXPECT_EQ(drawn().positions[0], Vec3f(0, 0, 0.5f));
  EXPECT_EQ(drawn().positions[2], Vec3f(0, 1, 1.5f));
  node()["weights"] = {2};
  EXPECT_EQ(drawn().positions[2], Vec3f(0, 1, 6));
  const int times = builder.add<float>({0, 1}, "SCALAR"), values = builder.add<float>({0, -4}, "SCALAR");
  json animation;
  animation["samplers"] = {{{"input", times}, {"output", values}}};
  animation["channels"] = {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}};
  builder.root["animations"] = {animation};
  EXPECT_EQ(drawn().positions[2], Vec3f(0, 1, 6));
  settings.at = 0.75;
  EXPECT_EQ(drawn().positions[2], Vec3f(0, 1, -9));
  settings.at = 0;
  EXPECT_EQ(drawn().positions[2], Vec3f(0, 1, 0));
}

// Of all targets, key by key; of a spline all tangents in, all values, all tangents out.
TEST_F(GltfMorph, ReadsTheWeightsOfSeveralTargets) {
  const int widen = builder.add<float>({0, 0, 0, 1, 0, 0, 0, 0, 0}, "VEC3");
  primitive()["targets"].push_back({{"POSITION", widen}});
  json animation;
  animation["samplers"] = {{{"input", builder.add<float>({0, 2}, "SCALAR")},
                            {"output", builder.add<std::uint8_t>({0, 255, 51, 0}, "SCALAR", true)}}};
  animation["channels"] = {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}};
  builder.root["animations"] = {animation};
  settings.at = 0;
  EXPECT_EQ(drawn().positions[1], Vec3f(2, 0, 0));
  settings.at = 1;
  EXPECT_EQ(drawn().positions[1], Vec3f(1.5f, 0, 0.2f));
  json& sampler = builder.root["animations"][0]["samplers"][0];
  const int spline = builder.add<float>({9, 9, 0, 1, 1, 0, 0, -1, 4, 1, 9, 9}, "SCALAR");
  sampler["output"] = spline;
  sampler["interpolation"] = "CUBICSPLINE";
  // Halfway: 2 / 8 * 1 + 4 / 2 - 2 / 8 * 0 = 2.25; 1 / 2 + 1 / 2 - 2 / 8 * -1 = 1.25.
  EXPECT_EQ(drawn().positions[1], Vec3f(2.25f, 0, 4.5f));
}

TEST_F(GltfMorph, MovesDirectionsAndKeepsThemUnit) {
  weigh(1);
  add_attribute("NORMAL", builder.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3"),
                builder.add<float>({0, 0, 0, 0, 1, 0, 0, 0, -1}, "VEC3"));
  const int tangents = builder.add<float>({1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, "VEC4");
  add_attribute("TANGENT", tangents,
                builder.add<std::int8_t>({0, 0, 0, 0, 0, 127, 0, 0, 127, 0, 0, 0}, "VEC4", true));
  builder.root["accessors"].back().update({{"type", "VEC3"}});
  builder.root["bufferViews"].back()["byteStride"] = 4;
  const Primitive p = drawn();
  const float r = float(std::sqrt(0.5));
  EXPECT_EQ(p.normals[0], Vec3f(0, 0, 1));
  EXPECT_EQ(p.normals[1], Vec3f(0, r, r));
  // It became zero; the triangle's plane rises by 1 along x and 2 along y.
  EXPECT_LT((p.normals[2] - Vec3f(-1, -2, 1).normalized()).length(), 1e-6f);
  EXPECT_EQ(p.tangents[0], Vec4f(1, 0, 0, -1));
  EXPECT_EQ(p.tangents[1], Vec4f(r, r, 0, -1));
}

TEST_F(GltfMorph, IgnoresTangentsWithoutNormals) {
  weigh(1);
  const int deltas = builder.add<float>({0, 1, 0, 0, 1, 0, 0, 1, 0}, "VEC3");
  add_attribute("TANGENT", builder.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4"), deltas);
  EXPECT_TRUE(drawn().tangents.empty());
  EXPECT_TRUE(drawn().normals.empty());
}

TEST_F(GltfMorph, MovesTextureCoordinatesAndColours) {
  weigh(0.5f);
  const int uvs = builder.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  add_attribute("TEXCOORD_0", uvs, builder.add<float>({0, 0, 0, 0, 4, 2}, "VEC2"));
  add_attribute("TEXCOORD_1", uvs, builder.add<std::int16_t>({0, 0, 32767, 0, 0, 0}, "VEC2", true));
  add_attribute("COLOR_0", builder.add<float>({.5f, .5f, .5f, .25f, 1, 0, 0, 1, 0, 0, 0, 1}, "VEC4"),
                builder.add<float>({.5f, 0, -.5f, 4, -4, 0, 0, 0, 0}, "VEC3"));
  const Primitive p = drawn();
  EXPECT_EQ(p.uvs[0][2], Vec2f(2, 2));
  EXPECT_EQ(p.uvs[1][1], Vec2f(1.5f, 0));
  EXPECT_EQ(p.colors[0], Vec4f(.75f, .5f, .25f, .25f));  // three components leave alpha
  EXPECT_EQ(p.colors[1], Vec4f(1, 0, 0, 1));             // clamped
  primitive()["targets"][0]["COLOR_0"] = builder.add<float>({0, 0, 0, .5f, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  EXPECT_EQ(drawn().colors[0], Vec4f(.5f, .5f, .5f, .5f));
}

TEST_F(GltfMorph, ReadsSparseAndQuantisedTargets) {
  weigh(1);
  json sparse = {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}};
  sparse["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", builder.add_view<std::uint8_t>({1})}, {"componentType", 5121}}},
      {"values", {{"bufferView", builder.add_view<float>({0, 0, 7})}}}};
  builder.root["accessors"].push_back(sparse);
  primitive()["targets"] = {{{"POSITION", int(builder.root["accessors"].size()) - 1}}};
  EXPECT_EQ(drawn().positions[0], Vec3f(0, 0, 0));
  EXPECT_EQ(drawn().positions[1], Vec3f(1, 0, 7));
  primitive()["targets"][0]["POSITION"] =
      builder.add<std::int16_t>({0, 0, -300, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
  builder.root["accessors"].back().update({{"type", "VEC3"}});
  builder.root["bufferViews"].back()["byteStride"] = 8;
  EXPECT_EQ(drawn().positions[0], Vec3f(0, 0, -300));
}

TEST_F(GltfMorph, LeavesOutTargetsWithoutTheAttribute) {
  weigh(1);
  primitive()["targets"] = {json::object()};
  EXPECT_EQ(drawn().positions[2], Vec3f(0, 1, 0));
}

// The rest pose takes nothing: its arrays are those of whoever else reads the accessors.
TEST_F(GltfMorph, SharesWhatIsNotMoved) {
  builder.add_mesh({{"POSITION", 0}});
  builder.root["nodes"] = {
      {{"mesh", 0}}, {{"mesh", 0}, {"weights", {0}}}, {{"mesh", 1}}, {{"mesh", 0}, {"weights", {-0.0}}}};
  const Scene scene = load(builder.glb());
  ASSERT_EQ(scene.meshes.size(), 2u);
  for (const int node : {0, 1, 3}) EXPECT_EQ(scene.nodes[std::size_t(node)].mesh, 0);
  EXPECT_EQ(scene.meshes[0].primitives[0].positions.data(), scene.meshes[1].primitives[0].positions.data());
}

TEST_F(GltfMorph, MakesAMeshForEachWeightThatIsDrawn) {
  builder.root["meshes"][0]["name"] = "m";
  builder.root["nodes"] = {{{"mesh", 0}, {"weights", {1}}},
                           {{"mesh", 0}},
                           {{"mesh", 0}, {"weights", {2}}},
                           {{"mesh", 0}, {"weights", {1}}},
                           {{"mesh", 0}, {"weights", {3}}}};
  builder.root["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
  Scene scene = load(builder.glb());
  ASSERT_EQ(scene.meshes.size(), 3u);
  const auto z = [&](int node) {
    const Mesh& mesh = scene.meshes[std::size_t(scene.nodes[std::size_t(node)].mesh)];
    EXPECT_EQ(mesh.name, "m");
    return mesh.primitives[0].positions[0].z;
  };
  EXPECT_EQ(z(0), 1);
  EXPECT_EQ(z(1), 0);
  EXPECT_EQ(z(2), 2);
  EXPECT_EQ(scene.nodes[0].mesh, scene.nodes[3].mesh);
  // Where nothing shows the rest pose, a moved mesh takes its place.
  builder.root["scenes"] = {{{"nodes", {0, 2, 3}}}};
  scene = load(builder.glb());
  EXPECT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(z(0), 1);
  EXPECT_EQ(z(2), 2);
}

TEST_F(GltfMorph, PrimitivesOfTheSameVerticesGoOnSharingThem) {
  weigh(1);
  add_attribute("NORMAL", builder.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3"), rise);
  json& primitives = builder.root["meshes"][0]["primitives"];
  json second = primitives[0];
  second["mode"] = 6;
  primitives.push_back(second);
  primitives.push_back(second);
  primitives[2]["targets"] = {json::object()};
  const Mesh mesh = load(builder.glb()).meshes.at(0);
  EXPECT_EQ(mesh.primitives[0].positions.data(), mesh.primitives[1].positions.data());
  EXPECT_EQ(mesh.primitives[0].normals.data(), mesh.primitives[1].normals.data());
  EXPECT_EQ(mesh.primitives[0].positions[0].z, 1);
  EXPECT_EQ(mesh.primitives[1].triangles[0], (Triangle{1, 2, 0}));
  EXPECT_EQ(mesh.primitives[2].positions[0].z, 0);
}

TEST_F(GltfMorph, RefusesTargetsThatDoNotFit) {
  const auto refused = [&](const std::string& place, const json& value, const std::string& expected) {
    GltfBuilder broken = builder;
    broken.root[json::json_pointer(place)] = value;
    const std::string message = refusal(broken.glb());
    EXPECT_EQ(message.substr(0, expected.size()), expected) << place << ": " << message;
  };
  weigh(1);
  const std::string targets = "/meshes/0/primitives/0/targets";
  const int two = builder.add<float>({0, 0, 0, 0, 0, 0}, "VEC3"),
            uvs = builder.add<float>({0, 0, 0, 0, 0, 0}, "VEC2"),
            huge = builder.add<float>({3e38f, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  refused(targets, 1, targets + ": expected an array of objects");
  refused(targets + "/0", 1, targets + "/0: expected an object of accessor indices");
  refused(targets + "/0/POSITION", 99, targets + "/0/POSITION: expected an index into /accessors");
  refused(targets + "/0/POSITION", two,
          targets + "/0/POSITION: expected 3 elements, as many as the primitive has vertices, not 2");
  refused(targets + "/0/POSITION", uvs, targets + "/0/POSITION: expected an accessor of VEC3");
  refused(targets + "/0/NORMAL", rise, targets + "/0/NORMAL: expected no such member, since the primitive");
  refused("/meshes/0/weights", {1, 2}, "/meshes/0/weights: expected 1 numbers, as many as the mesh has");
  refused("/meshes/0/weights", "1", "/meshes/0/weights: expected an array of numbers");
  refused("/nodes/0/weights", {1, 2}, "/nodes/0/weights: expected 1 numbers, as many as the mesh has");
  refused("/nodes/0/weights", {1e39}, "/nodes/0/weights/0: expected an array of numbers, each in the range");
  json more = primitive();
  more["targets"].push_back(json::object());
  refused("/meshes/0/primitives/1", more,
          "/meshes/0/primitives/1/targets: expected 1 targets, as many as the first primitive has, not 2");
  primitive()["targets"][0]["POSITION"] = huge;
  refused("/meshes/0/weights", {2}, targets + ": expected a finite POSITION of vertex 0");
}

}  // namespace
}  // namespace parian
