// What Parian has no use for is in the file that it writes.
#include <gtest/gtest.h>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

/// A mesh with a skin of two joints, an animation of both and of the camera, and things nobody here reads.
class WriteForeign : public WriteTest {
 protected:
  void SetUp() override {
    WriteTest::SetUp();
    json& primitive = builder.add_triangle();
    primitive["attributes"]["JOINTS_0"] =
        builder.add<std::uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    primitive["attributes"]["WEIGHTS_0"] = builder.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    primitive["attributes"]["_HEAT"] = builder.add<float>({1, 2, 3}, "SCALAR");
    primitive["extras"] = {{"p", {1, 2.5, "x", nullptr}}};
    const int inputs = builder.add<float>({0, 1}, "SCALAR");
    const int outputs = builder.add<float>({0, 0, 0, 1, 1, 1}, "VEC3");
    json& root = builder.root;
    root["asset"]["copyright"] = "somebody";
    root["asset"]["extras"] = {{"tool", 7}};
    root["extensionsUsed"] = {"NOBODY_reads_this", "KHR_materials_unlit"};
    root["extensions"] = {{"NOBODY_reads_this", {{"deep", {{"a", {1, 2, 3}}}}}}};
    root["extras"] = {{"big", 9007199254740993}, {"small", 1.25e-300}};
    root["materials"] = {{{"name", "m"},
                          {"occlusionTexture", {{"index", 0}, {"strength", 0.5}}},
                          {"extras", {{"e", true}}},
                          {"extensions", {{"NOBODY_reads_this", {{"q", 1}}}}}},
                         {{"name", "unused"}}};
    primitive["material"] = 0;
    root["meshes"][0]["extras"] = "of the mesh";
    root["nodes"] = {{{"name", "body"}, {"mesh", 0}, {"skin", 0}, {"extras", {{"n", 0}}}},
                     {{"name", "joint a"}, {"children", {2}}},
                     {{"name", "joint b"}, {"translation", {0, 1, 0}}},
                     {{"name", "eye"}, {"camera", 0}}};
    root["cameras"] = {{{"type", "perspective"},
                        {"extras", 5},
                        {"perspective", {{"yfov", 0.7}, {"znear", 0.1}, {"extras", 6}}}}};
    root["skins"] = {{{"name", "skin"}, {"joints", {1, 2}}, {"skeleton", 1}, {"extras", 8}}};
    root["scenes"] = {{{"name", "second"}, {"nodes", {3}}}, {{"name", "main"}, {"nodes", {0, 1, 3}}}};
    root["scene"] = 1;
    root["samplers"] = {{{"minFilter", 9987}}};
    root["images"] = {{{"uri", "data:image/png;base64," + base64(png(path("p.png")))}}};
    root["textures"] = {{{"name", "occlusion"}, {"source", 0}, {"sampler", 0}}};
    const auto channel = [](int node, const char* what) {
      return json{{"sampler", node == 3 ? 1 : 0}, {"target", {{"node", node}, {"path", what}}}};
    };
    const json sampler = {{"input", inputs}, {"output", outputs}};
    root["animations"] = {
        {{"name", "wave"},
         {"channels", {channel(1, "translation"), channel(3, "translation")}},
         {"samplers", {sampler, sampler}}},
        {{"name", "look"}, {"channels", {channel(3, "scale")}}, {"samplers", {sampler, sampler}}}};
  }

  GltfBuilder builder;
};

/// Members of `expected` that are as they were. `but`: those that may be others.
void expect_same(const json& expected, const json& actual, const std::vector<std::string>& but) {
  for (const auto& [key, value] : expected.items()) {
    if (std::ranges::find(but, key) != but.end()) continue;
    EXPECT_EQ(value.dump(), actual.value(key, json()).dump()) << key;
  }
}

TEST_F(WriteForeign, IsAllThere) {
  Loaded loaded = load_source(builder);
  const json root = written(loaded);
  expect_same(builder.root, root, {"asset", "accessors", "bufferViews", "extensionsUsed"});
  EXPECT_EQ(root["asset"]["copyright"], "somebody");
  EXPECT_EQ(root["asset"]["extras"], builder.root["asset"]["extras"]);
  EXPECT_TRUE(root["asset"]["generator"].get<std::string>().starts_with("Parian "));
  // The one that nothing uses is no longer listed.
  EXPECT_EQ(root["extensionsUsed"], json::array({"NOBODY_reads_this"}));
  EXPECT_EQ(root["accessors"], builder.root["accessors"]);
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// A change of one value leaves all else.
TEST_F(WriteForeign, SurvivesChanges) {
  Loaded loaded = load_source(builder);
  loaded.scene.materials[0].roughness = 0.25f;
  loaded.scene.cameras[0].yfov = 0.5f;
  const json root = written(loaded);
  expect_same(builder.root, root, {"asset", "materials", "cameras", "extensionsUsed"});
  json material = builder.root["materials"][0], camera = builder.root["cameras"][0];
  material["pbrMetallicRoughness"]["roughnessFactor"] = 0.25;
  camera["perspective"]["yfov"] = 0.5;
  EXPECT_EQ(root["materials"][0], material);
  EXPECT_EQ(root["cameras"][0], camera);
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

/// The scene without node `gone` (and what its number shifts).
void remove_node(Scene& scene, int gone) {
  scene.nodes.erase(scene.nodes.begin() + gone);
  const auto shift = [&](std::vector<int>& numbers) {
    std::erase(numbers, gone);
    for (int& number : numbers) number -= number > gone;
  };
  shift(scene.roots);
  for (Node& node : scene.nodes) shift(node.children);
}

TEST_F(WriteForeign, ChannelsOfRemovedNodesGoWithThem) {
  Loaded loaded = load_source(builder);
  remove_node(loaded.scene, 3);
  const json root = written(loaded);
  ASSERT_EQ(root["animations"].size(), 1u);  // the other one had no node but that
  EXPECT_EQ(root["animations"][0]["name"], "wave");
  EXPECT_EQ(root["animations"][0]["channels"].size(), 1u);
  EXPECT_EQ(root["animations"][0]["channels"][0]["target"]["node"], 1);
  EXPECT_EQ(root["animations"][0]["samplers"].size(), 1u);
  EXPECT_FALSE(root["scenes"][0].contains("nodes"));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

TEST_F(WriteForeign, NumbersFollowNodesThatMove) {
  Loaded loaded = load_source(builder);
  // A new node before all others.
  Scene& scene = loaded.scene;
  for (int& root : scene.roots) ++root;
  for (Node& node : scene.nodes)
    for (int& child : node.children) ++child;
  scene.nodes.insert(scene.nodes.begin(), Node());
  const json root = written(loaded);
  EXPECT_EQ(root["skins"][0]["joints"], json::array({2, 3}));
  EXPECT_EQ(root["skins"][0]["skeleton"], 2);
  EXPECT_EQ(root["animations"][1]["channels"][0]["target"]["node"], 4);
  EXPECT_EQ(root["scenes"][0]["nodes"], json::array({4}));
  EXPECT_EQ(root["nodes"][1]["skin"], 0);
  EXPECT_EQ(again(loaded).scene, scene);
}

// What the scene shows is written where the file would show something else.
TEST_F(WriteForeign, ASkinWhoseJointIsGoneIsBaked) {
  Loaded loaded = load_source(builder);
  loaded.scene.nodes[1].children.clear();
  remove_node(loaded.scene, 2);
  const json root = written(loaded);
  EXPECT_FALSE(root.contains("skins"));
  EXPECT_FALSE(root["nodes"][0].contains("skin"));
  const Loaded read = again(loaded);
  EXPECT_EQ(read.scene.nodes.size(), loaded.scene.nodes.size());
  EXPECT_EQ(read.scene.meshes, loaded.scene.meshes);
}

TEST_F(WriteForeign, ASkinWhoseJointMovedIsBaked) {
  Loaded loaded = load_source(builder);
  loaded.scene.nodes[1].transform.translation = {0, 0, 9};
  const json root = written(loaded);
  EXPECT_TRUE(root.contains("skins"));
  EXPECT_FALSE(root["nodes"][0].contains("skin"));
  EXPECT_FALSE(root["nodes"][0].contains("mesh"));
  EXPECT_EQ(root["meshes"][0]["primitives"][0]["attributes"].contains("_HEAT"), true);
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// The copy of a skinned body is no longer its skin's, the body is.
TEST_F(WriteForeign, ACopyOfASkinnedMeshIsBakedBesideIt) {
  Loaded loaded = load_source(builder);
  Node copy = loaded.scene.nodes.back();
  ASSERT_EQ(copy.name, "body");
  copy.transform.translation = {5, 0, 0};
  loaded.scene.roots.push_back(int(loaded.scene.nodes.size()));
  loaded.scene.nodes.push_back(copy);
  const json root = written(loaded);
  EXPECT_EQ(root["nodes"][0]["skin"], 0);
  EXPECT_EQ(root["nodes"].size(), 5u);
  ASSERT_EQ(root["meshes"].size(), 2u);
  const Scene scene = again(loaded).scene;
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].primitives[0].positions, scene.meshes[1].primitives[0].positions);
}

TEST_F(WriteForeign, MaterialsOfASkinnedMeshCanChange) {
  Loaded loaded = load_source(builder);
  loaded.scene.meshes[0].primitives[0].material = 1;
  const json root = written(loaded);
  EXPECT_EQ(root["nodes"][0]["skin"], 0);
  EXPECT_EQ(root["meshes"][0]["primitives"][0]["material"], 1);
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

TEST_F(WriteForeign, PointersOfAnimationsFollow) {
  json& target = builder.root["animations"][1]["channels"][0]["target"];
  target = {{"path", "pointer"},
            {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/3/translation"}}}}}};
  Loaded loaded = load_source(builder);
  EXPECT_EQ(written(loaded)["animations"], builder.root["animations"]);
  remove_node(loaded.scene, 0);
  EXPECT_EQ(
      written(
          loaded)["animations"][1]["channels"][0]["target"]["extensions"]["KHR_animation_pointer"]["pointer"],
      "/nodes/2/translation");
  remove_node(loaded.scene, 2);
  EXPECT_EQ(written(loaded)["animations"].size(), 1u);
}

}  // namespace
}  // namespace parian
