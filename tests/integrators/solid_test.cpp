// Pictures of solids whose radiance is known in closed form, and of solids against meshes.
#include <gtest/gtest.h>

#include "tests/integrators/support/render.h"
#include "tests/integrators/support/shapes.h"
#include "tests/support/block_test.h"

namespace parian {
namespace {

struct NamedShape {
  const char* name;
  Shape shape;
};

std::vector<NamedShape> shapes() {
  return {{"sphere", make_sphere(1)},
          {"cylinder", make_cylinder(0.8f, 0.8f, 1.2f)},
          {"cone", make_cylinder(0.9f, 0, 1.3f)},
          {"frustum", make_cylinder(0.4f, 0.9f, 1.1f)},
          {"box", make_flat_shape(ShapeKind::box, {1.2f, 1, 1.4f})}};
}

Transform stretched(bool mirrored) {
  Transform t;
  t.rotation = Quatf(0.9f, 0.1f, 0.3f, 0.2f).normalized();
  t.scale = {mirrored ? -1.2f : 1.2f, 0.8f, 1.1f};
  return t;
}

/// A convex body in a constant environment of radiance 1.
Scene furnace(const Shape& shape, const Rgb& albedo, const Transform& transform) {
  Scene scene;
  add_shape(scene, shape, add_material(scene, make_lambert(albedo)), transform);
  scene.environment.radiance = Rgb(1, 1, 1);
  add_eye(scene, {2, 2.5f, 3}, {0, 0, 0}, 0.7f);
  return scene;
}

// Albedo 1: each path brings exactly 1. Caught: self-hits, flipped normals, origins inside.
TEST(SolidFurnace, EveryPixelOfAWhiteBodyIsOne) {
  for (const NamedShape& shape : shapes())
    for (const Transform& transform : {Transform{}, stretched(false), stretched(true)}) {
      const Picture p = render(furnace(shape.shape, Rgb(1, 1, 1), transform),
                               independent_settings(96, 96, 16), with(Strategy::bsdf, 1));
      double worst = 0;
      for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) worst = std::max(worst, std::abs(double(p.at(x, y)[0]) - 1));
      EXPECT_LT(worst, 1e-5) << shape.name;
    }
}

/// A camera inside a closed body that emits 1 from both sides and reflects .5, .8 and .9.
Scene closed_emitter(const Shape& shape, const Transform& transform) {
  Scene scene;
  Material m = make_lambert({0.5f, 0.8f, 0.9f});
  m.emission = {1, 1, 1};
  m.double_sided = true;
  add_shape(scene, shape, add_material(scene, m), transform);
  add_eye(scene, {0.05f, -0.1f, 0.1f}, {0.95f, -0.3f, 0.7f}, 2);
  return scene;
}

// Caught: missing caps, a second nappe, acne and leaks darken it.
TEST(SolidFurnace, ClosedEmittersSumTheSeries) {
  for (const NamedShape& shape : shapes())
    for (const Transform& transform : {Transform{}, stretched(true)}) {
      const Picture p = render(closed_emitter(shape.shape, transform), independent_settings(64, 64, 56),
                               with(Strategy::bsdf));
      const double truths[] = {2, 5, 10};
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(mean_is(mean_of(p, k), truths[k], 0.01)) << shape.name;
    }
}

// The same with lights sampled: the surface lights itself, so samples start on the very solid that they end
// on. Caught: a point on the sphere that one strategy takes to be inside and the other outside.
TEST(SolidFurnace, ClosedEmittersSumTheSeriesWithLightSampling) {
  for (const NamedShape& shape : shapes())
    for (const Strategy strategy : {Strategy::mis, Strategy::light})
      for (const Transform& transform : {Transform{}, stretched(true)}) {
        // By area alone the near part of a wall is found too seldom: its variance is infinite in principle.
        const bool by_area = strategy == Strategy::light;
        const Picture p = render(closed_emitter(shape.shape, transform),
                                 independent_settings(64, 64, by_area ? 256 : 64), with(strategy, 4));
        const double truths[] = {0.5, 0.8, 0.9};
        for (int k = 0; k < 3; ++k)
          EXPECT_TRUE(
              mean_is(mean_of(p, k), (1 - std::pow(truths[k], 5)) / (1 - truths[k]), by_area ? 0.05 : 0.01))
              << shape.name << ", strategy " << int(strategy);
      }
}

TEST(NightlySolidFurnace, ClosedEmittersSumTheSeriesToHalfAPercent) {
  for (const NamedShape& shape : shapes())
    for (const Strategy strategy : {Strategy::bsdf, Strategy::mis})
      for (const Transform& transform : {Transform{}, stretched(true)}) {
        const Picture p =
            render(closed_emitter(shape.shape, transform), independent_settings(64, 64, 400), with(strategy));
        const double truths[] = {2, 5, 10};
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(mean_is(mean_of(p, k), truths[k], 0.005)) << shape.name;
      }
}

/// A sphere of radius 1 and radiance 1 at distance `height`, `theta` degrees off the normal of a small
/// Lambert plate of albedo .5 at the origin.
Scene sphere_over_plate(double distance, double theta) {
  Scene scene;
  const double angle = theta * std::numbers::pi / 180;
  const Vec3f center(Vec3d(std::sin(angle) * distance, std::cos(angle) * distance, 0));
  add_shape(scene, make_sphere(1), add_material(scene, make_emitter({1, 1, 1})), translate(center));
  add_shape(scene, make_flat_shape(ShapeKind::plane, {0.02f, 1, 0.02f}),
            add_material(scene, make_lambert({0.5f, 0.5f, 0.5f})));
  add_probe(scene, {0, 0, 0}, normalize(Vec3f(-0.3f, 1, 0.4f)), 0.3f, 0.002f);
  return scene;
}

// Also partly below the horizon.
TEST(SolidLight, SpheresOverAPlate) {
  struct Case {
    double distance, theta, factor;
  };
  for (const Case& c :
       {Case{2, 60, .125}, {2, 75, .070410}, {2, 90, .028834}, {2, 110, .002150}, {1.2, 90, .166943}})
    for (const Strategy strategy : {Strategy::light, Strategy::mis, Strategy::bsdf}) {
      // Rays of the plate alone seldom find a light at the horizon.
      if (strategy == Strategy::bsdf && c.theta > 100) continue;
      const Picture p =
          render(sphere_over_plate(c.distance, c.theta),
                 independent_settings(32, 32, strategy == Strategy::bsdf ? 1600 : 150), with(strategy));
      const double tolerance = c.theta > 100 ? 0.05 : strategy == Strategy::bsdf ? 0.03 : 0.02;
      EXPECT_TRUE(mean_is(mean_of(p, 0), 0.5 * c.factor, tolerance))
          << c.distance << " " << c.theta << ", strategy " << int(strategy);
    }
}

TEST(NightlySolidLight, SpheresOverAPlateToThreeInAThousand) {
  struct Case {
    double distance, theta, factor;
  };
  for (const Case& c : {Case{2, 60, .125}, {2, 75, .070410}, {2, 90, .028834}, {1.2, 90, .166943}}) {
    const Picture p = render(sphere_over_plate(c.distance, c.theta), independent_settings(64, 64, 1500),
                             with(Strategy::mis));
    EXPECT_TRUE(mean_is(mean_of(p, 0), 0.5 * c.factor, 0.003)) << c.distance << " " << c.theta;
  }
}

/// A floor lit by one lamp, and a wall that takes its shadow.
Scene lamp(const Shape& shape, const Transform& transform, const Material& material) {
  Scene scene;
  add_shape(scene, shape, add_material(scene, material), transform);
  const int grey = add_material(scene, make_lambert({0.6f, 0.6f, 0.6f}));
  add_shape(scene, make_flat_shape(ShapeKind::plane, {8, 1, 8}), grey, translate({0, -1.5f, 0}));
  add_shape(scene, make_cylinder(0.2f, 0.2f, 1), grey, translate({0.9f, -0.9f, 0.4f}));
  add_eye(scene, {2, 3, 5}, {0, -0.6f, 0}, 0.8f);
  return scene;
}

// Every kind of lamp, found by either strategy, with and without a texture on it. Caught: a density in the
// wrong measure, uvs of the light sample that are not those of the hit.
TEST(SolidLight, StrategiesAgree) {
  for (const NamedShape& shape : shapes())
    for (const bool textured : {false, true}) {
      Material m = make_lambert({0.1f, 0.1f, 0.1f});
      m.emission = {5, 5, 5};
      Scene scene = lamp(shape.shape, stretched(true), m);
      if (textured)
        scene.materials[0].emission_texture = add_texture(
            scene, make_image<float>(2, 2, 3, PixelType::f32, {1, 0, 0, 0, 1, 0, 0, 0, 1, .2f, .2f, 0}));
      RenderSettings settings = independent_settings(64, 48, 64, 5);
      settings.layers.variance = true;
      const Picture mis = render(scene, settings, with(Strategy::mis, 2));
      settings.seed = 6;
      settings.spp = 256;
      EXPECT_TRUE(blocks_agree(mis, render(scene, settings, with(Strategy::bsdf, 2)))) << shape.name;
      settings.spp = 64;
      EXPECT_TRUE(blocks_agree(mis, render(scene, settings, with(Strategy::light, 2)))) << shape.name;
    }
}

/// A textured ball with a normal map, by a solid or by a mesh of many triangles.
Scene ball(bool solid, bool mirrored) {
  Scene scene;
  Material m = make_lambert({1, 1, 1});
  m.base_color_texture = add_texture(
      scene, make_image<float>(4, 2, 3, PixelType::f32, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1,   1,   0,
                                                         0, 1, 1, 1, 0, 1, 1, 1, 1, .3f, .3f, .3f}));
  // A slope to the right and up, so that a mirrored tangent shows.
  m.normal_texture = add_texture(scene, make_image<float>(1, 1, 3, PixelType::f32, {0.75f, 0.65f, 0.9f}));
  const int material = add_material(scene, m);
  Transform t;
  t.rotation = Quatf(0.9f, 0.2f, -0.3f, 0.1f).normalized();
  t.scale = {mirrored ? -1.0f : 1.0f, 1, 1};
  if (solid) {
    add_shape(scene, make_sphere(1), material, t);
  } else {
    constexpr int kRings = 200, kSectors = 400;
    std::vector<Vec3f> positions, normals;
    std::vector<Vec2f> uvs;
    std::vector<Triangle> triangles;
    for (int j = 0; j <= kRings; ++j)
      for (int i = 0; i <= kSectors; ++i) {
        const double u = double(i) / kSectors, v = double(j) / kRings;
        const double phi = 2 * std::numbers::pi * (u - 0.5), theta = std::numbers::pi * v;
        positions.push_back(
            Vec3f(Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi))));
        normals.push_back(positions.back());
        uvs.emplace_back(float(u), float(v));
      }
    for (int j = 0; j < kRings; ++j)
      for (int i = 0; i < kSectors; ++i) {
        const auto a = std::uint32_t(j * (kSectors + 1) + i), c = a + kSectors + 1;
        triangles.push_back({a, c, c + 1});
        triangles.push_back({a, c + 1, a + 1});
      }
    Primitive p;
    p.positions = std::move(positions);
    p.normals = std::move(normals);
    p.uvs[0] = std::move(uvs);
    p.triangles = std::move(triangles);
    add_mesh(scene, p, material, t);
  }
  Light sun;
  sun.kind = LightKind::directional;
  add_light(scene, sun, look_along({0, 0, 0}, normalize(Vec3f(-1, -1, -2))));
  add_eye(scene, {0, 0, 3}, {0, 0, 0}, 0.75f);
  return scene;
}

// Texture coordinates and tangents are those that a mesh of the documented coordinates has.
TEST(SolidTexture, LooksAsOnAFineMesh) {
  for (const bool mirrored : {false, true}) {
    RenderSettings settings = independent_settings(64, 64, 64, 7);
    settings.layers.variance = true;
    const Picture solid = render(ball(true, mirrored), settings);
    settings.seed = 8;
    const Picture mesh = render(ball(false, mirrored), settings);
    double sum = 0, difference = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        for (int k = 0; k < 3; ++k) {
          sum += solid.at(x, y)[k];
          difference += std::abs(double(solid.at(x, y)[k]) - mesh.at(x, y)[k]);
        }
    EXPECT_GT(sum, 400);
    // Noise at the borders of texels and of the ball.
    EXPECT_LT(difference, 0.02 * sum);
  }
}

// Scale: the same still life 10^-6 to 10^6 times as large is the same picture.
TEST(SolidScale, PicturesDoNotDependOnIt) {
  const auto scene_of = [](float s) {
    Scene scene;
    add_shape(scene, make_sphere(s), add_material(scene, make_lambert({0.8f, 0.4f, 0.2f})),
              translate({-1.2f * s, 0, 0}));
    add_shape(scene, make_cylinder(s, 0, 2 * s), add_material(scene, make_lambert({0.2f, 0.5f, 0.8f})),
              translate({1.2f * s, 0, 0}));
    add_shape(scene, make_flat_shape(ShapeKind::plane, Vec3f(20 * s)),
              add_material(scene, make_lambert({0.5f, 0.5f, 0.5f})), translate({0, -s, 0}));
    Material m = make_emitter({3, 3, 3});
    add_shape(scene, make_sphere(0.7f * s), add_material(scene, m), translate({0, 3 * s, s}));
    scene.environment.radiance = Rgb(0.1f, 0.1f, 0.1f);
    add_eye(scene, Vec3f(0, 1.5f, 6) * s, Vec3f(0, 0.3f, 0) * s, 0.8f);
    return scene;
  };
  RenderSettings settings = independent_settings(64, 48, 64, 9);
  settings.layers.variance = true;
  const Picture reference = render(scene_of(1), settings);
  for (const float s : {1e-6f, 1e-3f, 1e3f, 1e6f}) {
    settings.seed += 1;
    EXPECT_TRUE(blocks_agree(reference, render(scene_of(s), settings))) << s;
  }
}

}  // namespace
}  // namespace parian
