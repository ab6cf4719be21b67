// Scenes of several files.
#include <gtest/gtest.h>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

class WriteComposed : public WriteTest {
 protected:
  /// A file whose names and places are its own.
  std::string file(const std::string& name) {
    GltfBuilder builder;
    builder.add_triangle()["material"] = 0;
    builder.root["materials"] = {{{"name", name}, {"normalTexture", {{"index", 0}}}}};
    builder.root["images"] = {
        {{"name", name}, {"bufferView", builder.add_bytes(png(path("p.png"), int(name.size()), 1))}}};
    builder.root["textures"] = {{{"source", 0}}};
    builder.root["nodes"] = {{{"name", name}, {"mesh", 0}, {"children", {1}}}, {{"name", name + " below"}}};
    builder.root["scenes"] = {{{"name", name}, {"nodes", {0}}}};
    const int times = builder.add<float>({0, 1}, "SCALAR"),
              values = builder.add<float>({0, 0, 0, 1, 1, 1}, "VEC3");
    builder.root["animations"] = {
        {{"name", name},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "scale"}}}}}},
         {"samplers", {{{"input", times}, {"output", values}}}}}};
    builder.root["extensions"]["NOBODY_" + name]["of"] = name;
    builder.root["extensionsUsed"] = {"NOBODY_both", "NOBODY_" + name};
    return write(name + ".glb", builder.glb());
  }

  Loaded load_both() {
    Loaded both;
    std::vector<std::string> notes;
    LoadSettings with;
    with.sources = &both.sources;
    both.scene = load_scene({file("one"), file("other")}, with, notes);
    return both;
  }
};

TEST_F(WriteComposed, HaveWhatAllFilesHave) {
  const Loaded both = load_both();
  EXPECT_EQ(both.scene.nodes[2].origin.file, 1);
  EXPECT_EQ(both.scene.nodes[2].origin.index, 0);
  for (const char* name : {"x.glb", "x.gltf"}) EXPECT_EQ(again(both, name).scene, both.scene);
  const json root = written(both);
  ASSERT_EQ(root["animations"].size(), 2u);
  EXPECT_EQ(root["animations"][1]["channels"][0]["target"]["node"], 3);
  EXPECT_EQ(root["materials"][1]["normalTexture"]["index"], 1);
  EXPECT_EQ(root["scenes"].size(), 2u);
  EXPECT_EQ(root["scenes"][0]["nodes"], json::array({0, 2}));
}

// Caught: extensions of the second file lost; a name twice in the list.
TEST_F(WriteComposed, HaveTheExtensionsOfAll) {
  const json root = written(load_both());
  EXPECT_EQ(root["extensionsUsed"], json::array({"NOBODY_both", "NOBODY_one", "NOBODY_other"}));
  for (const std::string name : {"one", "other"})
    EXPECT_EQ(root["extensions"].value("NOBODY_" + name, json()), (json{{"of", name}}));
}

// What only a file without anything left in the scene had goes with it.
TEST_F(WriteComposed, AFileThatIsGoneLeavesNothing) {
  Loaded both = load_both();
  std::vector<std::string> notes;
  both.scene = load_scene({path("one.glb")}, {}, notes);  // origins of file 0
  const json root = written(both);
  EXPECT_EQ(root["animations"].size(), 1u);
  EXPECT_EQ(root["nodes"].size(), 2u);
  EXPECT_EQ(root["accessors"].size(), 3u);
}

}  // namespace
}  // namespace parian
