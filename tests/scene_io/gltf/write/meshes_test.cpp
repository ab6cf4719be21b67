// Meshes of a file whose vertices change.
#include <gtest/gtest.h>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

class WriteMeshes : public WriteTest {
 protected:
  WriteMeshes() {
    triangle_ = builder_.add_triangle();
    builder_.root["nodes"] = {{{"mesh", 0}}};
  }
  json& primitives() { return builder_.root["meshes"][0]["primitives"]; }
  static void move(Loaded& loaded) {
    loaded.scene.meshes[0].primitives[0].positions = std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  }

  GltfBuilder builder_;
  json triangle_;
};

// Caught: values for as many vertices as there were; tangents that the reader passes over.
TEST_F(WriteMeshes, OtherAttributesStayWhileTheyFit) {
  primitives()[0]["attributes"]["_HEAT"] = builder_.add<float>({1, 2, 3}, "SCALAR");
  primitives()[0]["attributes"]["TANGENT"] =
      builder_.add<float>({1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4");
  Loaded loaded = load_source(builder_);
  const auto attributes = [&] { return written(loaded)["meshes"][0]["primitives"][0]["attributes"]; };
  move(loaded);
  EXPECT_TRUE(attributes().contains("_HEAT"));
  EXPECT_FALSE(attributes().contains("TANGENT"));
  Primitive& p = loaded.scene.meshes[0].primitives[0];
  p.positions = std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}};
  p.triangles = std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}};
  EXPECT_FALSE(attributes().contains("_HEAT"));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// Points and lines. Caught: primitives that are not drawn, gone; their targets beside others without any.
TEST_F(WriteMeshes, WhatIsNotDrawnStaysWhereItWas) {
  const json target = {{"POSITION", builder_.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3")}};
  json points = triangle_, lines = triangle_, drawn = triangle_;
  points["mode"] = 0;
  lines["mode"] = 1;
  for (json* p : {&points, &lines, &drawn}) (*p)["targets"] = {target};
  primitives() = {points, drawn, lines};
  Loaded loaded = load_source(builder_);
  ASSERT_EQ(loaded.scene.meshes.at(0).primitives.size(), 1u);
  move(loaded);
  const json out = written(loaded)["meshes"][0]["primitives"];
  ASSERT_EQ(out.size(), 3u);
  EXPECT_EQ(out[0].value("mode", 4), 0);
  EXPECT_EQ(out[1].value("mode", 4), 4);
  EXPECT_EQ(out[2].value("mode", 4), 1);
  for (const json& p : out) EXPECT_FALSE(p.contains("targets"));
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

// Caught: a list of triangles read as the strip that was there before.
TEST_F(WriteMeshes, AStripThatChangesIsNone) {
  primitives()[0]["mode"] = 5;
  Loaded loaded = load_source(builder_);
  EXPECT_EQ(written(loaded)["meshes"][0]["primitives"][0].value("mode", 4), 5);
  Primitive& p = loaded.scene.meshes[0].primitives[0];
  p.positions = std::vector<Vec3f>{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {2, 2, 0}};
  p.triangles = std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}};
  EXPECT_EQ(again(loaded).scene, loaded.scene);
}

}  // namespace
}  // namespace parian
