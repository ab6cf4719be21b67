// What lights send to a point, in closed form.
#include <gtest/gtest.h>

#include "tests/renderer/light/support/lit_scene.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr double kPiD = std::numbers::pi;

TEST(Irradiance, ADiskAboveThePoint) {
  for (const auto& [radius, height] : {std::pair(1.0f, 1.0f), {2.0f, 1.0f}, {0.3f, 2.0f}}) {
    Scene scene;
    add_light(scene, disk(2 * radius, 3), above(height));
    const double ratio = double(radius) * radius / (double(radius) * radius + double(height) * height);
    expect_irradiance(scene, {0, 1, 0}, 3 * kPiD * ratio, 0.015);
  }
}

TEST(Irradiance, ASquareAboveThePoint) {
  for (const auto& [side, factor] : {std::pair(2.0f, 0.554126), {1.0f, 0.239456}}) {
    Scene area, mesh;
    add_light(area, rectangle(side, side, 2), above(1));
    expect_irradiance(area, {0, 1, 0}, 2 * kPiD * factor);
    const int emitter = add_material(mesh, make_emitter({2, 2, 2}));
    add_mesh(mesh, make_quad({0, 1, 0}, {side / 2, 0, 0}, {0, 0, side / 2}), emitter);
    expect_irradiance(mesh, {0, 1, 0}, 2 * kPiD * factor);
  }
}

// Receiver normal y; a unit square standing on its plane at distance 1, one corner in front of the point.
TEST(Irradiance, APerpendicularSquare) {
  Scene scene;
  add_light(scene, rectangle(1, 1), look_along({0.5f, 0.5f, -1}, {0, 0, 1}));
  expect_irradiance(scene, {0, 1, 0}, kPiD * 0.055734, 0.01);
}

// The node's scale enlarges an area light by its largest component (EXT_lights_area).
TEST(Irradiance, AScaledSquare) {
  Scene scene;
  Transform down = above(1);
  Node holder;
  holder.transform = scale({0.5f, 1, 2});
  add_light(scene, rectangle(1, 1), down);
  holder.children = {0};
  scene.roots.clear();
  add_root(scene, holder);
  expect_irradiance(scene, {0, 1, 0}, kPiD * 0.554126);
}

// I = 10 at height 2, offset 1: rho .5 reflects .284705.
TEST(Irradiance, APoint) {
  Scene scene;
  add_light(scene, make_light(LightKind::point, 10), translate({1, 2, 0}));
  const LitScene lit(scene);
  const auto s = sample(lit, {0, 0, 0}, 0);
  ASSERT_TRUE(s);
  EXPECT_TRUE(s->delta);
  EXPECT_EQ(s->pdf, 1);
  EXPECT_EQ(s->target, Vec3f(1, 2, 0));
  EXPECT_NEAR(0.5 / kPiD * s->radiance.x * s->wi.y, 0.284705, 1e-6);
}

// 20 and 30 degrees: glTF's falloff, linear in the cosine and squared, gives .533211 I; a smoothstep .610355.
TEST(Irradiance, ASpot) {
  Scene scene;
  Light spot = make_light(LightKind::spot, 2);
  spot.inner_angle = kPi / 9;
  spot.outer_angle = kPi / 6;
  add_light(scene, spot, look_along({1, 2, 3}, {0.6f, 0, 0.8f}));
  const LitScene lit(scene);
  const Frame frame = make_frame({0.6f, 0, 0.8f});
  double flux = 0;
  constexpr int kSteps = 100000;
  for (int i = 0; i < kSteps; ++i) {
    const float cosine = 1 - 2 * (float(i) + 0.5f) / kSteps, sine = std::sqrt(1 - cosine * cosine);
    const Vec3f w = frame.to_world({sine, 0, cosine});
    const auto s = sample(lit, Vec3f(1, 2, 3) + w * 2, 0);
    if (s) flux += s->radiance.x * 4 * 4 * kPiD / kSteps;  // times the square of the distance
    if (cosine < 0.86f) {
      ASSERT_FALSE(s) << "outside the cone";
    }
  }
  EXPECT_NEAR(flux / 2, 0.533211, 1e-4);
}

TEST(Irradiance, ADirectional) {
  Scene scene;
  add_light(scene, make_light(LightKind::directional, 3), look_along({5, 5, 5}, {0.6f, -0.8f, 0}));
  const LitScene lit(scene);
  const auto s = sample(lit, {1, 2, 3}, 0);
  ASSERT_TRUE(s);
  EXPECT_TRUE(s->delta && s->at_infinity);
  EXPECT_NEAR((s->wi - Vec3f(-0.6f, 0.8f, 0)).length(), 0, 1e-6);
  EXPECT_EQ(s->radiance.x, 3);
}

// KHR_lights_punctual: (1 - (d / range)^4) / d^2.
TEST(Irradiance, ARangeWindowsPunctualLights) {
  Scene scene;
  Light light = make_light(LightKind::point, 16);
  light.range = 4;
  add_light(scene, light);
  const LitScene lit(scene);
  EXPECT_NEAR(sample(lit, {2, 0, 0}, 0)->radiance.x, 4 * 15.0 / 16, 1e-5);
  EXPECT_FALSE(sample(lit, {4, 0, 0}, 0));
  EXPECT_FALSE(sample(lit, {5, 0, 0}, 0));
}

// A texture that is black in its left half: the right half of the square alone, by symmetry half of it.
TEST(Irradiance, ATexturedEmitter) {
  Scene scene;
  Texture nearest;
  nearest.filter = Filter::nearest;
  Material emitter = make_emitter({2, 1, 1});
  emitter.emission_texture =
      add_texture(scene, make_image<std::uint8_t>(2, 1, 1, PixelType::u8, {0, 188}), nearest);
  const int material = add_material(scene, emitter);
  add_mesh(scene, make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), material);
  expect_irradiance(scene, {0, 1, 0}, 2 * 0.502886 * kPiD * 0.554126 / 2, 0.015);
}

// The square in 80 pieces of unequal radiance: an own number chooses; in 3: one number serves twice. Re-using
// u for the point without rescaling it biases.
TEST(Irradiance, ManyLightsAddUpWithoutBias) {
  for (const int pieces : {3, 80}) {
    Scene scene;
    const float width = 2.0f / float(pieces);
    double truth = 0;
    for (int i = 0; i < pieces; ++i) {
      const float x = -1 + (float(i) + 0.5f) * width, radiance = float(1 + i * i % 5);
      add_light(scene, rectangle(width, 2, radiance), look_along({x, 1, 0}, {0, -1, 0}));
      // By the midpoint rule: dE = L cos^2 / d^2 dA, cos = 1 / d.
      for (int j = 0; j < 300; ++j)
        for (int k = 0; k < 20; ++k) {
          const double px = x + ((k + 0.5) / 20 - 0.5) * width, pz = -1 + (j + 0.5) / 150,
                       d2 = 1 + px * px + pz * pz;
          truth += radiance / (d2 * d2) * (double(width) / 20) / 150;
        }
    }
    expect_irradiance(scene, {0, 1, 0}, truth, 0.01);
  }
}

}  // namespace
}  // namespace parian
