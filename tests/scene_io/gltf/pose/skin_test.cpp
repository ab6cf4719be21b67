// Skins: vertices follow their joints, in world space.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

const float kHalfRoot = float(std::sqrt(0.5));

class GltfSkin : public GltfTest {
 protected:
  /// Three vertices at x = 1/2 of an upright limb: at the root, at the elbow, at the tip. The joints are
  /// nodes 0 and, one above it, 1; node 2 shows the mesh.
  void SetUp() override {
    GltfTest::SetUp();
    const int positions = builder.add<float>({.5f, 0, 0, .5f, 1, 0, .5f, 2, 0}, "VEC3");
    const int normals = builder.add<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    const int tangents = builder.add<float>({0, 1, 0, 1, 0, 1, 0, -1, 0, 1, 0, -1}, "VEC4");
    const int joints = builder.add<std::uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4");
    const int weights = builder.add<float>({1, 0, 0, 0, .5f, .5f, 0, 0, 1, 0, 0, 0}, "VEC4");
    builder.add_mesh({{"POSITION", positions},
                      {"NORMAL", normals},
                      {"TANGENT", tangents},
                      {"JOINTS_0", joints},
                      {"WEIGHTS_0", weights}});
    const int matrices = builder.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,  //
                                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                                            "MAT4");
    builder.root["nodes"] = {
        {{"children", {1}}}, {{"translation", {0, 1, 0}}}, {{"mesh", 0}, {"skin", 0}, {"name", "arm"}}};
    builder.root["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", matrices}}};
  }

  void bend() { builder.root["nodes"][1]["rotation"] = {0, 0, kHalfRoot, kHalfRoot}; }

  json& attributes() { return builder.root["meshes"][0]["primitives"][0]["attributes"]; }

  Primitive drawn() {
    scene = load(builder.glb());
    return scene.meshes.at(std::size_t(scene.nodes.at(std::size_t(scene.roots.back())).mesh))
        .primitives.at(0);
  }

  static void expect_near(const Vec3f& a, const Vec3f& b) { EXPECT_LT((a - b).length(), 1e-6f) << a << b; }

  /// Where the vertex (0, 0, 0) goes that has these influences, the joints being at x = 0, 1, 2, ...
  float moved_to(const std::function<void()>& influence, std::size_t joints = 5) {
    builder.root["nodes"] = json::array();
    json numbers = json::array();
    for (std::size_t j = 0; j < joints; ++j) {
      builder.root["nodes"].push_back({{"translation", {j, 0, 0}}});
      numbers.push_back(j);
    }
    builder.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
    builder.root["skins"] = {{{"joints", numbers}}};
    const int positions = builder.add<float>({0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
    attributes() = {{"POSITION", positions}};
    influence();
    return drawn().positions[0].x;
  }

  template <class T>
  int same_for_all(std::vector<T> values, bool normalized = false) {
    std::vector<T> all;
    for (int i = 0; i < 3; ++i) all.insert(all.end(), values.begin(), values.end());
    return builder.add(all, "VEC4", normalized);
  }

  void influence(const char* set, int joints, int weights) {
    attributes()[std::string("JOINTS_") + set] = joints;
    attributes()[std::string("WEIGHTS_") + set] = weights;
  }

  GltfBuilder builder;
  Scene scene;
};

TEST_F(GltfSkin, LeavesTheBindPoseAsItIs) {
  const Primitive p = drawn();
  EXPECT_EQ(p.positions[0], Vec3f(.5f, 0, 0));
  EXPECT_EQ(p.positions[1], Vec3f(.5f, 1, 0));
  EXPECT_EQ(p.positions[2], Vec3f(.5f, 2, 0));
  EXPECT_EQ(p.normals[1], Vec3f(1, 0, 0));
}

TEST_F(GltfSkin, Bends) {
  bend();
  const Primitive p = drawn();
  expect_near(p.positions[0], {.5f, 0, 0});
  expect_near(p.positions[1], {.25f, 1.25f, 0});  // the mean of (.5, 1) and (0, 1.5)
  expect_near(p.positions[2], {-1, 1.5f, 0});
  expect_near(p.normals[0], {1, 0, 0});
  expect_near(p.normals[1], {kHalfRoot, kHalfRoot, 0});
  expect_near(p.normals[2], {0, 1, 0});
  expect_near({p.tangents[1].x, p.tangents[1].y, p.tangents[1].z}, {-kHalfRoot, kHalfRoot, 0});
  EXPECT_EQ(p.tangents[0].w, 1);
  EXPECT_EQ(p.tangents[1].w, -1);
  expect_near({p.tangents[2].x, p.tangents[2].y, p.tangents[2].z}, {-1, 0, 0});
}

TEST_F(GltfSkin, BendsWithTheAnimation) {
  json animation;
  animation["samplers"] = {
      {{"input", builder.add<float>({0, 1}, "SCALAR")},
       {"output", builder.add<float>({0, 0, 0, 1, 0, 0, kHalfRoot, kHalfRoot}, "VEC4")}}};
  animation["channels"] = {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}};
  builder.root["animations"] = {animation};
  EXPECT_EQ(drawn().positions[2], Vec3f(.5f, 2, 0));
  settings.at = 0.5;  // by 45 degrees
  expect_near(drawn().positions[2], {-kHalfRoot / 2, 1 + 1.5f * kHalfRoot, 0});
  settings.at = 1;
  expect_near(drawn().positions[2], {-1, 1.5f, 0});
}

TEST_F(GltfSkin, MovesWithWhatIsAboveItsJoints) {
  builder.root["nodes"].push_back({{"children", {0}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}});
  expect_near(drawn().positions[2], {11, 4, 0});
}

// The mesh is in world space: in a root of its own, whatever is above the node, and under its name.
TEST_F(GltfSkin, IgnoresThePlaceOfTheMesh) {
  bend();
  builder.root["nodes"][2]["translation"] = {7, 7, 7};
  builder.root["nodes"][2]["children"] = {4};
  builder.root["nodes"].push_back({{"children", {2}}, {"scale", {0, 0, 0}}});
  builder.root["nodes"].push_back({{"name", "sword"}});
  expect_near(drawn().positions[2], {-1, 1.5f, 0});
  ASSERT_EQ(scene.nodes.size(), 6u);
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 3, 5}));
  EXPECT_EQ(scene.nodes[2].mesh, kNone);
  EXPECT_EQ(scene.nodes[2].children, std::vector<int>{4});
  EXPECT_EQ(scene.nodes[5].name, "arm");
  EXPECT_EQ(scene.nodes[5].transform, Transform());
  EXPECT_EQ(scene.nodes[5].mesh, 0);  // in place of the mesh that nothing shows as it was
  EXPECT_EQ(scene.meshes.size(), 1u);
}

TEST_F(GltfSkin, LeavesMeshesWithoutASkinAlone) {
  bend();
  builder.root["nodes"].push_back({{"mesh", 0}});
  scene = load(builder.glb());
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.nodes[3].mesh, 0);
  EXPECT_EQ(scene.meshes[0].primitives[0].positions[2], Vec3f(.5f, 2, 0));
  EXPECT_EQ(scene.nodes[4].mesh, 1);
  expect_near(scene.meshes[1].primitives[0].positions[2], {-1, 1.5f, 0});
}

TEST_F(GltfSkin, MakesAMeshForEachSkin) {
  builder.root["nodes"].push_back({{"translation", {0, 0, 5}}});
  builder.root["skins"].push_back({{"joints", {0, 3}}});
  for (const int skin : {1, 0}) builder.root["nodes"].push_back({{"mesh", 0}, {"skin", skin}});
  scene = load(builder.glb());
  EXPECT_EQ(scene.meshes.size(), 2u);
  std::vector<float> tips;
  for (const int root : scene.roots) {
    const int mesh = scene.nodes[std::size_t(root)].mesh;
    if (mesh != kNone) tips.push_back(scene.meshes[std::size_t(mesh)].primitives[0].positions[2].z);
  }
  std::ranges::sort(tips);
  EXPECT_EQ(tips, (std::vector<float>{0, 0, 5}));
}

TEST_F(GltfSkin, MorphsBeforeItBends) {
  bend();
  const int deltas = builder.add<float>({0, 0, 0, 0, 0, 0, 0, 1, 0}, "VEC3");
  builder.root["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", deltas}}};
  builder.root["nodes"][2]["weights"] = {2};
  expect_near(drawn().positions[2], {-3, 1.5f, 0});
}

// Normals by the inverse transpose, directions in the surface by the matrix.
TEST_F(GltfSkin, KeepsNormalsAcrossASurfaceThatIsStretched) {
  attributes()["NORMAL"] =
      builder.add<float>({kHalfRoot, kHalfRoot, 0, kHalfRoot, kHalfRoot, 0, kHalfRoot, kHalfRoot, 0}, "VEC3");
  attributes()["TANGENT"] = builder.add<float>(
      {kHalfRoot, -kHalfRoot, 0, 1, kHalfRoot, -kHalfRoot, 0, 1, kHalfRoot, -kHalfRoot, 0, 1}, "VEC4");
  builder.root["nodes"][0]["scale"] = {2, 1, 1};
  const Primitive p = drawn();
  const float root5 = std::sqrt(5.0f);
  EXPECT_EQ(p.positions[0], Vec3f(1, 0, 0));
  expect_near(p.normals[0], {1 / root5, 2 / root5, 0});
  expect_near({p.tangents[0].x, p.tangents[0].y, p.tangents[0].z}, {2 / root5, -1 / root5, 0});
}

TEST_F(GltfSkin, KeepsTheOutsideOfMirroredSkins) {
  builder.root["nodes"][0]["scale"] = {1, 1, -1};
  const int side = builder.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  attributes()["POSITION"] = builder.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
  attributes()["NORMAL"] = side;
  json second = builder.root["meshes"][0]["primitives"][0];  // of the same vertices
  builder.root["meshes"][0]["primitives"].push_back(second);
  const Primitive p = drawn();
  expect_near(p.normals[0], {0, 0, -1});
  EXPECT_EQ(p.triangles[0], (Triangle{0, 2, 1}));
  EXPECT_EQ(scene.meshes[0].primitives[1].triangles[0], (Triangle{0, 2, 1}));
  EXPECT_EQ(p.tangents[0].w, -1);  // was 1
}

TEST_F(GltfSkin, WeighsJoints) {
  EXPECT_FLOAT_EQ(
      moved_to([&] {
        influence("0", same_for_all<std::uint16_t>({1, 4, 0, 0}), same_for_all<float>({.25f, .75f, 0, 0}));
      }),
      3.25f);
  EXPECT_FLOAT_EQ(moved_to([&] {
                    influence("0", same_for_all<std::uint8_t>({0, 0, 0, 4}),
                              same_for_all<std::uint8_t>({204, 0, 0, 51}, true));
                  }),
                  0.8f);
  EXPECT_FLOAT_EQ(moved_to([&] {
                    influence("0", same_for_all<std::uint8_t>({0, 0, 2, 0}),
                              same_for_all<std::uint16_t>({0, 0, 65535, 0}, true));
                  }),
                  2);
}

TEST_F(GltfSkin, WeightsNeedNotSumToOne) {
  for (const float scale : {2.0f, 0.01f}) {
    EXPECT_FLOAT_EQ(
        moved_to([&] {
          influence("0", same_for_all<std::uint8_t>({1, 2, 0, 0}), same_for_all<float>({scale, scale, 0, 0}));
        }),
        1.5f);
  }
  // Without any weight the first joint counts.
  EXPECT_FLOAT_EQ(
      moved_to([&] {
        influence("0", same_for_all<std::uint8_t>({3, 2, 0, 0}), same_for_all<float>({0, 0, 0, 0}));
      }),
      3);
}

TEST_F(GltfSkin, ReadsMoreThanFourJoints) {
  EXPECT_FLOAT_EQ(
      moved_to(
          [&] {
            influence("0", same_for_all<std::uint8_t>({0, 1, 2, 3}),
                      same_for_all<float>({.125f, .125f, .125f, .125f}));
            influence("1", same_for_all<std::uint8_t>({4, 5, 0, 0}), same_for_all<float>({.25f, .25f, 0, 0}));
          },
          6),
      0.125f * 6 + 0.25f * 9);
}

TEST_F(GltfSkin, RefusesSkinsThatDoNotFit) {
  const auto refused = [&](const std::string& place, const json& value, const std::string& expected) {
    GltfBuilder broken = builder;
    broken.root[json::json_pointer(place)] = value;
    const std::string message = refusal(broken.glb());
    EXPECT_EQ(message.substr(0, expected.size()), expected) << place << ": " << message;
  };
  const std::string at = "/meshes/0/primitives/0/attributes/";
  const int far = same_for_all<std::uint8_t>({0, 2, 0, 0}), bytes = same_for_all<std::uint8_t>({0, 1, 0, 0}),
            signed_bytes = same_for_all<std::int8_t>({0, 1, 0, 0}),
            signed_weights = same_for_all<std::int8_t>({0, 1, 0, 0}, true),
            normalized = same_for_all<std::uint8_t>({0, 1, 0, 0}, true),
            negative = same_for_all<float>({2, -1, 0, 0}),
            two = builder.add<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0}, "VEC4"),
            three = builder.add<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3"),
            one_matrix = builder.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4"),
            perspective = builder.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                                              1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1},
                                             "MAT4");
  refused(at + "JOINTS_0", far,
          at + "JOINTS_0: expected joints below 2, the number in the skin; vertex 0 has 2");
  refused(at + "JOINTS_0", signed_bytes, at + "JOINTS_0: expected an accessor of VEC4, unsigned 8 or 16 bit");
  refused(at + "JOINTS_0", normalized, at + "JOINTS_0: expected an accessor of VEC4, unsigned 8 or 16 bit");
  refused(at + "JOINTS_0", two, at + "JOINTS_0: expected 3 elements, as many as POSITION has, not 2");
  refused(at + "JOINTS_0", 99, at + "JOINTS_0: expected an index into /accessors");
  refused(at + "JOINTS_1", bytes, at + "WEIGHTS_1: expected an accessor, since a node draws");
  refused(at + "WEIGHTS_1", negative, at + "JOINTS_1: expected an accessor, since a node draws");
  refused(at + "WEIGHTS_0", negative, at + "WEIGHTS_0: expected no negative weights; vertex 0 has -1");
  refused(at + "WEIGHTS_0", bytes, at + "WEIGHTS_0: expected an accessor of VEC4, float or normalized");
  refused(at + "WEIGHTS_0", signed_weights,
          at + "WEIGHTS_0: expected an accessor of VEC4, float or normalized");
  refused(at + "WEIGHTS_0", three, at + "WEIGHTS_0: expected an accessor of VEC4, float or normalized");
  refused(at.substr(0, at.size() - 1), {{"POSITION", 0}},
          at + "JOINTS_0: expected an accessor, since a node");
  refused("/skins/0/inverseBindMatrices", one_matrix,
          "/skins/0/inverseBindMatrices: expected at least 2 elements, the number of joints, not 1");
  refused("/skins/0/inverseBindMatrices", three,
          "/skins/0/inverseBindMatrices: expected an accessor of MAT4");
  refused("/skins/0/inverseBindMatrices", perspective,
          "/skins/0/inverseBindMatrices: expected affine matrices; element 1");
  refused("/skins/0/inverseBindMatrices", 99, "/skins/0/inverseBindMatrices: expected an index");
  refused("/skins/0/joints/1", 3, "/skins/0/joints/1: expected an index into /nodes (0 to 2)");
  refused("/skins/0/joints", json::array(), "/skins/0/joints: expected at least one joint");
  refused("/skins/0", json::object(), "/skins/0/joints: expected an index into /nodes");
  refused("/nodes/2/skin", 1, "/nodes/2/skin: expected an index into /skins (0 to 0)");
  refused("/nodes/0", {{"children", {1}}, {"scale", {1e38, 1e38, 1e38}}, {"translation", {3e38, 3e38, 3e38}}},
          "/meshes/0/primitives/0: expected a finite position of vertex");
  refused("/nodes/1/children", {0}, "/nodes/0/children: expected no cycle");
  refused("/nodes/2/children", {1}, "/nodes/2/children/0: expected a node without another parent");
}

}  // namespace
}  // namespace parian
