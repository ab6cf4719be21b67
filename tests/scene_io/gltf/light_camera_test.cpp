// Cameras and lights.
#include <gtest/gtest.h>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfLightCamera : public GltfTest {
 protected:
  Camera camera(const json& source) {
    GltfBuilder builder;
    builder.root["cameras"] = {source};
    return load(builder.glb()).cameras.at(0);
  }
};

TEST_F(GltfLightCamera, ReadsPerspectiveCameras) {
  Camera c = camera({{"name", "eye"},
                     {"type", "perspective"},
                     {"perspective", {{"yfov", .75}, {"aspectRatio", 1.5}, {"znear", .5}, {"zfar", 50}}}});
  EXPECT_EQ(c.name, "eye");
  EXPECT_EQ(c.projection, Projection::perspective);
  EXPECT_EQ(c.yfov, .75f);
  EXPECT_EQ(c.aspect, 1.5f);
  EXPECT_EQ(c.znear, .5f);
  EXPECT_EQ(c.zfar, 50);
  EXPECT_FALSE(c.lens);
  c = camera({{"type", "perspective"}, {"perspective", {{"yfov", .75}, {"znear", .5}}}});
  EXPECT_EQ(c.aspect, 0);
  EXPECT_EQ(c.zfar, 0);
}

TEST_F(GltfLightCamera, ReadsOrthographicCameras) {
  const Camera c = camera(
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 2}, {"ymag", 3}, {"znear", 0}, {"zfar", 9}}}});
  EXPECT_EQ(c.projection, Projection::orthographic);
  EXPECT_EQ(c.xmag, 2);
  EXPECT_EQ(c.ymag, 3);
  EXPECT_EQ(c.zfar, 9);
}

TEST_F(GltfLightCamera, ReadsLenses) {
  const auto physical = [&](json extension) {
    extension["focalLength"] = .035;
    extension["sensorSize"] = {.036, .024};
    return camera({{"type", "perspective"},
                   {"perspective", {{"yfov", .66}, {"znear", .01}}},
                   {"extensions", {{"EXT_camera_physical", extension}}}})
        .lens;
  };
  const auto lens = physical({{"fStop", 2}, {"focusDistance", 5}});
  EXPECT_EQ(lens,
            (Lens{.focal_length = .035f, .f_stop = 2, .focus_distance = 5, .sensor_size = {.036f, .024f}}));
  EXPECT_FALSE(physical({{"focusDistance", 5}}));
  EXPECT_TRUE(warnings.empty());
  EXPECT_FALSE(physical({{"fStop", 2}}));
  EXPECT_EQ(warnings.size(), 1u);
}

TEST_F(GltfLightCamera, ReadsPunctualLights) {
  GltfBuilder builder;
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}},
      {{"name", "s"},
       {"type", "spot"},
       {"color", {.1, .2, .3}},
       {"intensity", 7},
       {"range", 8},
       {"spot", {{"innerConeAngle", .1}, {"outerConeAngle", .2}}}},
      {{"type", "directional"}, {"intensity", 10000000000}},
      {{"type", "spot"}, {"spot", json::object()}}};
  builder.root["nodes"] = {{{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}}};
  const Scene scene = load(builder.glb());
  ASSERT_EQ(scene.lights.size(), 4u);
  EXPECT_EQ(scene.lights[0], Light());
  Light spot;
  spot.name = "s";
  spot.kind = LightKind::spot;
  spot.color = {.1f, .2f, .3f};
  spot.intensity = 7;
  spot.range = 8;
  spot.inner_angle = .1f;
  spot.outer_angle = .2f;
  EXPECT_EQ(scene.lights[1], spot);
  EXPECT_EQ(scene.lights[2].kind, LightKind::directional);
  EXPECT_EQ(scene.lights[2].intensity, 1e10f);  // more than tinygltf's int holds
  EXPECT_EQ(scene.lights[3].inner_angle, 0);
  EXPECT_EQ(scene.lights[3].outer_angle, kPi / 4);
  EXPECT_EQ(scene.nodes[0].light, 1);
}

TEST_F(GltfLightCamera, ReadsAreaLights) {
  GltfBuilder builder;
  builder.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  builder.root["extensions"]["EXT_lights_area"]["lights"] = {
      {{"type", "rect"}, {"color", {1, .5, 0}}, {"intensity", 3}, {"size", 2}, {"rect", {{"aspect", 1.5}}}},
      {{"type", "disk"}, {"size", 4}}};
  const json area = {{"light", 1}}, point = {{"light", 0}};
  builder.root["nodes"] = {
      {{"name", "both"}, {"extensions", {{"EXT_lights_area", area}, {"KHR_lights_punctual", point}}}},
      {{"extensions", {{"EXT_lights_area", area}}}}};
  const Scene scene = load(builder.glb());
  ASSERT_EQ(scene.lights.size(), 3u);
  const Light& rect = scene.lights[1];
  EXPECT_EQ(rect.kind, LightKind::rectangle);
  EXPECT_EQ(rect.color, Rgb(1, .5f, 0));
  EXPECT_EQ(rect.intensity, 3);
  EXPECT_EQ(rect.width, 3);
  EXPECT_EQ(rect.height, 2);
  const Light& disk = scene.lights[2];
  EXPECT_EQ(disk.kind, LightKind::disk);
  EXPECT_EQ(disk.intensity, 1000);
  EXPECT_EQ(disk.width, 4);
  // A node with two lights: the second is at a child of its own.
  EXPECT_EQ(scene.nodes[0].light, 0);
  ASSERT_EQ(scene.nodes[0].children, std::vector<int>{2});
  EXPECT_EQ(scene.nodes[2].light, 2);
  EXPECT_EQ(scene.nodes[1].light, 2);
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace parian
