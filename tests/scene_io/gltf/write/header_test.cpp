// The lists of extensions, and the elements that nothing refers to any more.
#include <gtest/gtest.h>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

class WriteHeader : public WriteTest {
 protected:
  WriteHeader() {
    builder_.add_triangle()["material"] = 0;
    builder_.root["materials"] = {json::object()};
    builder_.root["nodes"] = {{{"mesh", 0}}};
  }

  GltfBuilder builder_;
};

// Caught: no list of the required ones; one that has what is used no more.
TEST_F(WriteHeader, WhatIsRequiredStaysSoWhileItIsUsed) {
  json& root = builder_.root;
  root["materials"][0]["extensions"]["KHR_materials_unlit"] = json::object();
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    root[list] = {"KHR_materials_unlit", "KHR_node_visibility"};
  root["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  Loaded loaded = load_source(builder_);
  json out = written(loaded);
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) EXPECT_EQ(out[list], root[list]) << list;
  loaded.scene.nodes[0].visible = true;
  out = written(loaded);
  for (const char* list : {"extensionsUsed", "extensionsRequired"})
    EXPECT_EQ(out[list], json::array({"KHR_materials_unlit"})) << list;
}

// Caught: the one extension that has no object anywhere, not listed.
TEST_F(WriteHeader, QuantizedAttributesAreListed) {
  json& root = builder_.root;
  const int normals = builder_.add<std::int8_t>({0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0}, "VEC4", true);
  root["accessors"][std::size_t(normals)].update({{"type", "VEC3"}});
  root["bufferViews"][std::size_t(normals)]["byteStride"] = 4;
  root["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = normals;
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) root[list] = {"KHR_mesh_quantization"};
  Loaded loaded = load_source(builder_);
  json out = written(loaded);
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) EXPECT_EQ(out[list], root[list]) << list;
  EXPECT_EQ(again(loaded).scene, loaded.scene);
  loaded.scene.meshes[0].primitives[0].normals = std::vector<Vec3f>(3, Vec3f(1, 0, 0));
  EXPECT_FALSE(written(loaded).contains("extensionsRequired")) << "floats now";
}

// Caught: elements thrown away to which an extension that nobody here knows may refer.
TEST_F(WriteHeader, UnusedElementsGoWhereNothingElseCanUseThem) {
  const auto change = [](Loaded loaded) {
    Primitive& primitive = loaded.scene.meshes[0].primitives[0];
    primitive.positions = std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    return loaded;
  };
  EXPECT_EQ(written(change(load_source(builder_)))["accessors"].size(), 1u);
  builder_.use_extension("NOBODY_reads_this");
  EXPECT_EQ(written(change(load_source(builder_)))["accessors"].size(), 2u);
  builder_.root["extensionsUsed"] = {"KHR_materials_variants"};
  EXPECT_EQ(written(change(load_source(builder_)))["accessors"].size(), 1u) << "its references are known";
}

// Caught: somebody's own words in extras taken for extensions.
TEST_F(WriteHeader, ExtrasUseNoExtensions) {
  builder_.root["nodes"][0]["extras"]["extensions"]["KHR_materials_unlit"] = json::object();
  EXPECT_FALSE(written(load_source(builder_)).contains("extensionsUsed"));
}

}  // namespace
}  // namespace parian
