// Nodes: transforms, the tree, instances, and which scene is drawn.
#include <gtest/gtest.h>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfNode : public GltfTest {
 protected:
  Node node(const json& source) {
    builder.root["nodes"] = {source};
    return load(builder.glb()).nodes.at(0);
  }

  GltfBuilder builder;
};

Vec3d moved(const Transform& transform, const Vec3d& point) { return point * transform.to_matrix(); }

TEST_F(GltfNode, ReadsTranslationRotationScale) {
  // A quarter turn about z, x, y, z, w; the scale mirrors and is not uniform.
  const Node n =
      node({{"name", "n"}, {"translation", {1, 2, 3}}, {"rotation", {0, 0, 1, 1}}, {"scale", {2, -3, 4}}});
  EXPECT_EQ(n.name, "n");
  EXPECT_FALSE(n.transform.matrix);
  EXPECT_EQ(n.transform.scale, Vec3f(2, -3, 4));
  EXPECT_LT((moved(n.transform, {1, 0, 0}) - Vec3d(1, 4, 3)).length(), 1e-6);
  EXPECT_LT((moved(n.transform, {0, 1, 0}) - Vec3d(4, 2, 3)).length(), 1e-6);
  EXPECT_LT((moved(n.transform, {0, 0, 1}) - Vec3d(1, 2, 7)).length(), 1e-6);
  EXPECT_EQ(node(json::object()).transform, Transform());
}

TEST_F(GltfNode, ReadsMatrices) {
  // Columns: images of x, y, z, origin.
  const Node n = node({{"matrix", {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, -4, 0, 5, 6, 7, 1}}});
  ASSERT_TRUE(n.transform.matrix);
  EXPECT_EQ(moved(n.transform, {1, 0, 0}), Vec3d(5, 8, 7));
  EXPECT_EQ(moved(n.transform, {0, 1, 0}), Vec3d(2, 6, 7));
  EXPECT_EQ(moved(n.transform, {0, 0, 1}), Vec3d(5, 6, 3));
}

TEST_F(GltfNode, RefusesTransformsThatAreNone) {
  const std::vector<std::pair<json, std::string>> cases = {
      {{{"matrix", {1, 0, 0, .5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}}, "/nodes/0/matrix/3: expected 0"},
      {{{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0}}}, "/nodes/0/matrix/15: expected 1"},
      {{{"matrix", {1, 0, 0}}}, "/nodes/0/matrix: expected 16 numbers"},
      {{{"rotation", {0, 0, 0, 0}}}, "/nodes/0/rotation: expected a unit quaternion"},
      {{{"translation", {0, 1e39, 0}}}, "/nodes/0/translation/1: expected"},
      {{{"scale", {0, "1", 0}}}, "/nodes/0/scale/1: expected"},
  };
  for (const auto& [source, expected] : cases) {
    builder.root["nodes"] = {source};
    EXPECT_EQ(refusal(builder.glb()).substr(0, expected.size()), expected);
  }
}

TEST_F(GltfNode, ReadsVisibility) {
  const auto visible = [&](const json& extension) {
    return node({{"extensions", {{"KHR_node_visibility", extension}}}}).visible;
  };
  EXPECT_TRUE(node(json::object()).visible);
  EXPECT_TRUE(visible(json::object()));
  EXPECT_TRUE(visible({{"visible", true}}));
  EXPECT_FALSE(visible({{"visible", false}}));
  builder.root["nodes"] = {{{"extensions", {{"KHR_node_visibility", {{"visible", 0}}}}}}};
  EXPECT_TRUE(
      refusal(builder.glb()).starts_with("/nodes/0/extensions/KHR_node_visibility/visible: expected"));
}

TEST_F(GltfNode, DrawsTheDefaultScene) {
  builder.root["nodes"] = {{{"children", {1}}}, json::object(), json::object(), json::object()};
  EXPECT_EQ(load(builder.glb()).roots, (std::vector<int>{0, 2, 3}));  // without scenes: all
  builder.root["scenes"] = {{{"nodes", {3}}}, {{"nodes", {2, 0}}}};
  EXPECT_EQ(load(builder.glb()).roots, std::vector<int>{3});
  builder.root["scene"] = 1;
  const Scene scene = load(builder.glb());
  EXPECT_EQ(scene.roots, (std::vector<int>{2, 0}));
  EXPECT_EQ(scene.nodes.size(), 4u);
  EXPECT_EQ(scene.nodes[0].children, std::vector<int>{1});
}

TEST_F(GltfNode, RefusesGraphsThatAreNoForest) {
  struct Case {
    json nodes, scenes;
    std::string expected;
  };
  const std::vector<Case> cases = {
      {{{{"children", {0}}}}, nullptr, "/nodes/0/children: expected no cycle"},
      {{{{"children", {1}}}, {{"children", {2}}}, {{"children", {0}}}},
       nullptr,
       "/nodes/0/children: expected no cycle"},
      {{{{"children", {2}}}, {{"children", {2}}}, json::object()},
       nullptr,
       "/nodes/1/children/0: expected a node without another"},
      {{{{"children", {1, 1}}}, json::object()},
       nullptr,
       "/nodes/0/children/1: expected a node without another"},
      {{{{"children", {1}}}, json::object()},
       {{{"nodes", {1}}}},
       "/scenes/0/nodes/0: expected a node without a parent"},
      {{json::object()},
       {{{"nodes", {0, 0}}}},
       "/scenes/0/nodes/1: expected a node without a parent, listed once"},
  };
  for (const Case& c : cases) {
    builder.root["nodes"] = c.nodes;
    builder.root.erase("scenes");
    if (!c.scenes.is_null()) builder.root["scenes"] = c.scenes;
    EXPECT_EQ(refusal(builder.glb()).substr(0, c.expected.size()), c.expected);
  }
}

// Recursion over the tree would end here.
TEST_F(GltfNode, ReadsVeryDeepTrees) {
  constexpr int kDepth = 100'000;
  json nodes = json::array();
  for (int i = 0; i + 1 < kDepth; ++i) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back(json::object());
  builder.root["nodes"] = std::move(nodes);
  EXPECT_EQ(load(builder.glb()).nodes.size(), std::size_t(kDepth));
}

TEST_F(GltfNode, ReadsInstances) {
  builder.add_triangle();
  const int translation = builder.add<float>({1, 2, 3, 4, 5, 6}, "VEC3");
  const int rotation = builder.add<std::int8_t>({0, 0, 0, 127, 0, 127, 0, 0}, "VEC4", true);
  const int scale = builder.add<float>({1, 1, 1, 2, 2, 2}, "VEC3");
  const json attributes = {
      {"TRANSLATION", translation}, {"ROTATION", rotation}, {"SCALE", scale}, {"_ID", 0}};
  Node n = node({{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}});
  ASSERT_EQ(n.instances.size(), 2u);
  EXPECT_EQ(n.instances[0].translation, Vec3f(1, 2, 3));
  EXPECT_EQ(n.instances[0].rotation, Quatf(1, 0, 0, 0));
  EXPECT_EQ(n.instances[1].rotation, Quatf(0, 0, 1, 0));
  EXPECT_EQ(n.instances[1].scale, Vec3f(2, 2, 2));
  n = node(
      {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"SCALE", scale}}}}}}}});
  ASSERT_EQ(n.instances.size(), 2u);
  EXPECT_EQ(n.instances[1].translation, Vec3f(0));
}

TEST_F(GltfNode, RefusesInstancesOfDifferentCounts) {
  builder.add_triangle();
  const int translation = builder.add<float>({1, 2, 3, 4, 5, 6}, "VEC3"),
            scale = builder.add<float>({1, 1, 1}, "VEC3");
  const json attributes = {{"TRANSLATION", translation}, {"SCALE", scale}};
  builder.root["nodes"] = {
      {{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", attributes}}}}}}};
  EXPECT_EQ(refusal(builder.glb()),
            "/nodes/0/extensions/EXT_mesh_gpu_instancing/attributes/SCALE: expected 2 elements, as many as "
            "the others "
            "have, not 1");
}

}  // namespace
}  // namespace parian
