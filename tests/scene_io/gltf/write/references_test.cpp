// References that are found nowhere but in the document follow, or go with what they referred to.
#include <gtest/gtest.h>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

class WriteReferences : public WriteTest {
 protected:
  WriteReferences() {
    builder_.add_triangle()["material"] = 0;
    json& root = builder_.root;
    root["materials"] = {{{"name", "zero"}}, {{"name", "one"}}, {{"name", "two"}}};
    root["nodes"] = {{{"name", "a"}, {"mesh", 0}}, {{"name", "b"}}, {{"name", "c"}}};
    root["scenes"] = {{{"nodes", {0, 1, 2}}}};
  }

  GltfBuilder builder_;
};

// Caught: channels with the numbers that their samplers had.
TEST_F(WriteReferences, ChannelsFindTheirSamplers) {
  const int times = builder_.add<float>({0, 1}, "SCALAR");
  json samplers, channels;
  for (int i = 0; i < 3; ++i) {
    const int values = builder_.add<float>({0, 0, 0, 1, 1, float(i)}, "VEC3");
    samplers.push_back({{"input", times}, {"output", values}});
    channels.push_back({{"sampler", 2 - i}, {"target", {{"node", i}, {"path", "translation"}}}});
  }
  builder_.root["animations"] = {{{"channels", channels}, {"samplers", samplers}}};
  Loaded loaded = load_source(builder_);
  loaded.scene.nodes.pop_back();  // which the first sampler moves
  loaded.scene.roots.pop_back();
  const json root = written(loaded);
  const json& animation = root["animations"][0];
  ASSERT_EQ(animation["channels"].size(), 2u);
  ASSERT_EQ(animation["samplers"].size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(animation["channels"][i]["target"]["node"], i);
    const auto sampler = animation["channels"][i]["sampler"].get<std::size_t>();
    const auto output = animation["samplers"].at(sampler)["output"].get<std::size_t>();
    const std::size_t view = root["accessors"][output]["bufferView"],
                      was = builder_.root["accessors"][4 - i]["bufferView"];
    ASSERT_EQ(root["bufferViews"][view]["byteLength"], 24);
    const std::size_t offset = root["bufferViews"][view]["byteOffset"];
    const std::string bytes = read_bytes(path("written.glb"));
    const std::string expected =
        builder_.binary.substr(builder_.root["bufferViews"][was]["byteOffset"].get<std::size_t>(), 24);
    std::uint32_t json_size;
    std::memcpy(&json_size, bytes.data() + 12, sizeof(json_size));
    EXPECT_EQ(bytes.substr(20 + json_size + 8 + offset, 24), expected) << i;
  }
}

// Caught: a variant that has no material left.
TEST_F(WriteReferences, VariantsFollowTheirMaterials) {
  json& primitive = builder_.root["meshes"][0]["primitives"][0];
  primitive["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 1}, {"variants", {0}}},
                                                                   {{"material", 2}, {"variants", {1}}}};
  builder_.root["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "x"}}, {{"name", "y"}}};
  builder_.use_extension("KHR_materials_variants");
  Loaded loaded = load_source(builder_);
  loaded.scene.materials.erase(loaded.scene.materials.begin() + 1);
  const json root = written(loaded);
  EXPECT_EQ(root["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"],
            json::parse(R"([{"material": 1, "variants": [1]}])"));
  EXPECT_EQ(root["materials"][1]["name"], "two");
}

// Caught: a node that is the child of another and a root as well, which glTF has not.
TEST_F(WriteReferences, OtherScenesHaveNoChildrenAsRoots) {
  builder_.root["scenes"] = {{{"nodes", {0, 1}}}, {{"nodes", {1, 2}}}};
  Loaded loaded = load_source(builder_);
  loaded.scene.nodes[0].children = {1};
  loaded.scene.roots = {0};
  EXPECT_EQ(written(loaded)["scenes"], json::parse(R"([{"nodes": [0]}, {"nodes": [2]}])"));
}

// Caught: pointers into other arrays than that of nodes, left as they were.
TEST_F(WriteReferences, PointersIntoMaterialsFollow) {
  const int times = builder_.add<float>({0, 1}, "SCALAR"), values = builder_.add<float>({0, 1}, "SCALAR");
  json channels;
  for (const char* pointer : {"/materials/1/alphaCutoff", "/materials/2/alphaCutoff"})
    channels.push_back(
        {{"sampler", 0},
         {"target",
          {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}}}});
  builder_.root["animations"] = {
      {{"channels", channels}, {"samplers", {{{"input", times}, {"output", values}}}}}};
  builder_.use_extension("KHR_animation_pointer");
  Loaded loaded = load_source(builder_);
  loaded.scene.materials.erase(loaded.scene.materials.begin() + 1);
  const json left = written(loaded)["animations"][0]["channels"];
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0]["target"]["extensions"]["KHR_animation_pointer"]["pointer"], "/materials/1/alphaCutoff");
}

// Caught: the environment of another scene changed with that of the default one.
TEST_F(WriteReferences, AnotherSceneKeepsItsEnvironment) {
  builder_.root["images"] = {{{"uri", "data:image/png;base64," + base64(png(path("p.png")))}}};
  builder_.root["extensions"]["EXT_lights_environment"]["environments"] = {{{"source", 0}, {"intensity", 2}}};
  builder_.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  for (json& scene : builder_.root["scenes"])
    scene["extensions"]["EXT_lights_environment"]["environment"] = 0;
  builder_.use_extension("EXT_lights_environment");
  Loaded loaded = load_source(builder_);
  loaded.scene.environment.radiance = Rgb(3);
  json root = written(loaded);
  const auto intensity = [&](std::size_t scene) {
    const std::size_t number = root["scenes"][scene]["extensions"]["EXT_lights_environment"]["environment"];
    return root["extensions"]["EXT_lights_environment"]["environments"][number]["intensity"];
  };
  EXPECT_EQ(intensity(0), 3);
  EXPECT_EQ(intensity(1), 2);
}

// Caught: an animation that moves the last of several copies, and not the node of the file.
TEST_F(WriteReferences, AnAnimationMovesTheFirstOfCopies) {
  const int times = builder_.add<float>({0, 1}, "SCALAR");
  const int values = builder_.add<float>({0, 0, 0, 1, 1, 1}, "VEC3");
  builder_.root["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "scale"}}}}}},
       {"samplers", {{{"input", times}, {"output", values}}}}}};
  Loaded loaded = load_source(builder_);
  loaded.scene.roots.push_back(3);
  loaded.scene.nodes.push_back(Node(loaded.scene.nodes[1]));
  EXPECT_EQ(written(loaded)["animations"][0]["channels"][0]["target"]["node"], 1);
}

}  // namespace
}  // namespace parian
