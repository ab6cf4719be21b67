// What deforms meshes: kept while it shows what the scene does, else gone with its animations.
#include <gtest/gtest.h>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

class WriteDeformations : public WriteTest {
 protected:
  /// A body with a skin below another node, and the skin's joint.
  void add_skinned() {
    json& primitive = builder_.add_triangle();
    primitive["attributes"]["JOINTS_0"] = builder_.add(std::vector<std::uint8_t>(12), "VEC4");
    primitive["attributes"]["WEIGHTS_0"] = builder_.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    json& root = builder_.root;
    root["nodes"] = {{{"name", "parent"}, {"children", {1}}},
                     {{"name", "body"}, {"mesh", 0}, {"skin", 0}},
                     {{"name", "joint"}, {"translation", {0, 1, 0}}}};
    root["skins"] = {{{"joints", {2}}}};
    root["scenes"] = {{{"nodes", {0, 2}}}};
  }

  /// A mesh with a morph target and weights of it, which an animation changes for node 0.
  void add_morphed() {
    json& primitive = builder_.add_triangle();
    primitive["targets"] = {{{"POSITION", builder_.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}}};
    json& root = builder_.root;
    root["meshes"][0]["weights"] = {1};
    root["nodes"] = {{{"mesh", 0}}};
    root["scenes"] = {{{"nodes", {0}}}};
    const int times = builder_.add<float>({0, 1}, "SCALAR");
    const int weights = builder_.add<float>({0, 1}, "SCALAR");
    const int places = builder_.add<float>({0, 0, 0, 1, 1, 1}, "VEC3");
    root["animations"] = {
        {{"channels",
          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}},
           {{"sampler", 1}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
         {"samplers", {{{"input", times}, {"output", weights}}, {{"input", times}, {"output", places}}}}}};
  }

  static std::vector<std::string> animated(const json& root) {
    std::vector<std::string> paths;
    for (const json& animation : root.value("animations", json::array()))
      for (const json& channel : animation["channels"]) paths.push_back(channel["target"]["path"]);
    return paths;
  }

  GltfBuilder builder_;
};

// Caught: a skinned mesh taken for one that is seen, since only its parent is hidden.
TEST_F(WriteDeformations, ASkinIsHiddenByTheParentsOfItsNode) {
  add_skinned();
  builder_.root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  builder_.use_extension("KHR_node_visibility");
  const Loaded hidden = load_source(builder_);
  ASSERT_EQ(hidden.scene.nodes.size(), 4u);
  EXPECT_FALSE(hidden.scene.nodes[3].visible);
  EXPECT_EQ(written(hidden)["nodes"][1].value("skin", -1), 0);
  EXPECT_EQ(again(hidden).scene, hidden.scene);
  // One that the file would hide, and the scene does not.
  Loaded shown = hidden;
  shown.scene.nodes[3].visible = true;
  EXPECT_FALSE(written(shown)["nodes"][1].contains("skin"));
  EXPECT_EQ(again(shown).scene, shown.scene);
}

// Caught: joints of vertices that no skin is to move any more.
TEST_F(WriteDeformations, WhatIsBakedHasNoJoints) {
  add_skinned();
  Loaded loaded = load_source(builder_);
  loaded.scene.meshes[0].primitives[0].positions = std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  const json root = written(loaded);
  const json& attributes = root["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_FALSE(attributes.contains("JOINTS_0"));
  EXPECT_FALSE(attributes.contains("WEIGHTS_0"));
  EXPECT_FALSE(root["nodes"][1].contains("skin"));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// Caught: an animation of weights of a mesh without targets, and one that moves a node with a matrix.
TEST_F(WriteDeformations, AnimationsThatCannotBeAreLeftOut) {
  add_morphed();
  const Loaded source = load_source(builder_);
  EXPECT_EQ(animated(written(source)), (std::vector<std::string>{"weights", "translation"}));
  Loaded loaded = source;
  loaded.scene.meshes[0].primitives[0].positions = std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_EQ(animated(written(loaded)), std::vector<std::string>{"translation"});
  EXPECT_EQ(again(loaded).scene, loaded.scene);
  loaded = source;
  loaded.scene.nodes[0].transform.matrix = Imath::M44f(1, 0.5f, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
  EXPECT_EQ(animated(written(loaded)), std::vector<std::string>{"weights"});
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// Caught: a new node that shows the mesh as its weights deform it, and not as the scene has it.
TEST_F(WriteDeformations, ANewNodeHasNoWeights) {
  add_morphed();
  builder_.root["nodes"][0]["weights"] = {0};
  builder_.root.erase("animations");
  Loaded loaded = load_source(builder_);
  ASSERT_EQ(loaded.scene.meshes.size(), 1u);
  EXPECT_EQ(loaded.scene.meshes[0].primitives[0].positions[0], Vec3f(0));
  Node added;
  added.mesh = 0;
  added.transform.translation = {5, 0, 0};
  loaded.scene.roots.push_back(1);
  loaded.scene.nodes.push_back(added);
  const Scene read = again(loaded).scene;
  EXPECT_EQ(read.meshes, loaded.scene.meshes);
  ASSERT_EQ(read.nodes.size(), 2u);
  EXPECT_EQ(read.nodes[1].mesh, 0);
}

// Caught: the weights of the file where those of a pose are shown.
TEST_F(WriteDeformations, APoseIsWrittenWithItsWeights) {
  add_morphed();
  LoadSettings posed;
  posed.at = 0.25;
  const Loaded loaded = load_source(builder_, posed);
  EXPECT_EQ(loaded.scene.meshes.at(0).primitives.at(0).positions[0], Vec3f(0, 0, 0.25f));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

}  // namespace
}  // namespace parian
