// Solids that emit: samples against their density, and the light they send against closed forms.
#include <gtest/gtest.h>

#include "tests/renderer/light/support/lit_scene.h"
#include "tests/support/chi_square.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

struct NamedLight {
  const char* name;
  Shape shape;
  Transform transform;
  bool double_sided = false;
};

Transform stretched() {
  Transform t;
  t.translation = {0.2f, 0.5f, -0.3f};
  t.rotation = Quatf(0.8f, 0.3f, -0.4f, 0.2f).normalized();
  t.scale = {1.5f, -0.6f, 0.9f};
  return t;
}

std::vector<NamedLight> lights() {
  Transform turned = stretched();
  turned.scale = Vec3f(1.3f);
  return {{"round sphere", make_sphere(0.5f), turned},
          {"ellipsoid", make_sphere(0.5f), stretched()},
          {"cylinder", make_cylinder(0.5f, 0.5f, 1), stretched()},
          {"cone", make_cylinder(0.6f, 0, 1), turned},
          {"frustum, both sides", make_cylinder(0.6f, 0.3f, 1), stretched(), true},
          {"sphere, both sides", make_sphere(0.5f), turned, true}};
}

Scene one_light(const NamedLight& light) {
  Scene scene;
  Material m = make_emitter({1, 1, 1});
  m.double_sided = light.double_sided;
  add_shape(scene, light.shape, add_material(scene, m), light.transform);
  return scene;
}

/// The density of every point on the ray from p along w that emits towards p, hidden or not.
float density(const LitScene& lit, const Vec3f& p, const Vec3f& w) {
  float sum = 0;
  for (std::uint32_t i = 0; i < lit.world.solids.size(); ++i) {
    const PlacedSolid& s = lit.world.solids[i];
    const Affined in = inverse(s.to_world);
    const Vec3d o = in.point(Vec3d(p)), d = in.vector(Vec3d(w));
    const auto chord = intersect(s.solid, o, d);
    if (!chord) continue;
    const bool round = s.is_round();
    for (const Crossing& c : {chord->enter, chord->leave}) {
      if (c.t <= 0) continue;
      const Vec3f q = project(s.solid, o + d * c.t, c.face);
      const Vec3f n = s.to_world.normal(surface_point(s.solid, q, c.face).normal).normalized();
      if (w.dot(n) >= 0 && !lit.world.solid_parts[s.part].material->double_sided) continue;
      const Hit hit{float(c.t), q.x, q.y, Hit::kSolid | i, 0, std::uint32_t(c.face), q.z};
      sum += lit.table.pdf_solid(hit, {p, Vec3f(0)}, std::abs(w.dot(n)));
      if (round) break;  // a cone of directions: what is first met
    }
  }
  return sum;
}

// Caught: a density of the object's area for that of its image, the second crossing of a cone of directions,
// a pdf that forgets the choice.
TEST(SolidLights, SamplesFollowTheirDensity) {
  const Vec3f p(0.9f, 1.9f, 1.2f);
  for (const NamedLight& light : lights()) {
    Scene scene = one_light(light);
    // A second lamp, or the choice would not be in the density.
    add_shape(scene, make_sphere(0.3f), add_material(scene, make_emitter({3, 3, 3})),
              translate({-0.6f, 1.4f, 0.8f}));
    const LitScene lit(std::move(scene));
    std::uint32_t i = 0;
    const auto draw = [&]() -> std::optional<Vec3f> {
      const auto s = sample(lit, p, i++);
      return s ? std::optional(s->wi) : std::nullopt;
    };
    SphereCells cells;
    cells.axis = normalize(light.transform.translation - p);
    cells.zoom = 0.02;
    cells.tolerance = 1e-5;
    EXPECT_TRUE(samples_directions(
        draw, [&](const Vec3f& w) { return density(lit, p, w); }, cells, 60000, 6))
        << light.name;
  }
}

// A sphere of radius R and radiance 1 at distance d straight above: pi R^2 / d^2. At every size and distance.
TEST(SolidLights, SpheresIrradiateAsTheyShould) {
  for (const double size : {1e-3, 1.0, 1e6})
    for (const double ratio : {1.5, 10.0, 1e3, 1e5}) {
      NamedLight light{"", make_sphere(float(size)), translate({0, float(size * ratio), 0})};
      const LitScene lit(one_light(light));
      const Statistics s = irradiance(lit, {0, 0, 0}, {0, 1, 0}, 4000);
      const double truth = std::numbers::pi / (ratio * ratio);
      EXPECT_NEAR(s.mean(), truth, 4.5 * s.standard_error() + 1e-5 * truth) << size << " " << ratio;
      EXPECT_LT(4.5 * s.standard_error(), 0.05 * truth);
    }
}

// From inside a closed emitter of both sides a surface receives pi, wherever and however it lies.
TEST(SolidLights, InsideAClosedEmitterIrradianceIsPi) {
  for (NamedLight light : lights()) {
    light.double_sided = true;
    const LitScene lit(one_light(light));
    const Affine& map = lit.world.solids[0].to_world;
    for (const Vec3f& local : {Vec3f(0, 0, 0), Vec3f(0.1f, -0.2f, 0.15f)}) {
      const Statistics s = irradiance(lit, map.point(local), normalize(Vec3f(0.3f, 0.8f, -0.5f)), 200000);
      EXPECT_NEAR(s.mean(), kPi, 4.5 * s.standard_error()) << light.name;
      EXPECT_LT(4.5 * s.standard_error(), 0.05 * kPi) << light.name;
    }
  }
}

// The sphere's closed form under the choice among several lights: densities with the choice in them.
TEST(SolidLights, ShareTheChoiceWithOtherLights) {
  Scene scene;
  const int material = add_material(scene, make_emitter({1, 1, 1}));
  add_shape(scene, make_sphere(1), material, translate({0, 4, 0}));
  add_shape(scene, make_cylinder(1, 1, 1), material, translate({0, -5, 0}));  // below the horizon
  add_mesh(scene, make_quad({0, -3, 0}, {1, 0, 0}, {0, 0, 1}), material);
  const LitScene lit(std::move(scene));
  EXPECT_EQ(lit.table.size(), 4);
  const Statistics s = irradiance(lit, {0, 0, 0}, {0, 1, 0}, 100000);
  EXPECT_NEAR(s.mean(), kPi / 16, 4.5 * s.standard_error());
  EXPECT_LT(4.5 * s.standard_error(), 0.03 * kPi / 16);
}

// Lights are chosen by the area of the image. Two black-bottomed lamps of equal radiance, one of them
// stretched to (2, 1, 1): 21.478 to 12.566.
TEST(SolidLights, AreChosenByTheAreaOfTheirImage) {
  Scene scene;
  const int material = add_material(scene, make_emitter({1, 1, 1}));
  add_shape(scene, make_sphere(1), material, translate({0, 50, 0}));
  Transform t = translate({0, -50, 0});
  t.scale = {2, 1, 1};
  add_shape(scene, make_sphere(1), material, t);
  const LitScene lit(std::move(scene));
  int stretched_one = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    Sampler sampler(SamplerKind::independent, 4, 0, 0, std::uint32_t(i));
    const Vec2f u = sampler.next2();
    const auto s = lit.table.sample({{0, 0, 0}, Vec3f(0)}, u, sampler);
    stretched_one += !s || s->wi.y < 0;  // half of the ellipsoid's points face away
  }
  EXPECT_NEAR(double(stretched_one) / kSamples, 21.478 / (21.478 + 12.566), 0.015);
}

// The shadow ray's end lies before the light's own surface.
TEST(SolidLights, TargetsClearTheSurface) {
  for (const NamedLight& light : lights()) {
    if (light.double_sided) continue;
    const LitScene lit(one_light(light));
    const PlacedSolid& placed = lit.world.solids[0];
    const Affined in = inverse(placed.to_world);
    for (const Vec3f& p : {Vec3f(3, 4, 5), Vec3f(-300, 20, 100)})
      for (std::uint32_t i = 0; i < 2000; ++i) {
        const auto s = sample(lit, p, i);
        if (!s) continue;
        const auto chord = intersect(placed.solid, in.point(Vec3d(p)), in.vector(Vec3d(s->target - p)));
        // What lies well before the target (t = 1) is another part of the solid, which hides it for good.
        if (chord && std::abs(chord->enter.t - 1) < 1e-4) {
          EXPECT_GT(chord->enter.t, 1 - 1e-5) << light.name;
        }
      }
  }
}

}  // namespace
}  // namespace parian
