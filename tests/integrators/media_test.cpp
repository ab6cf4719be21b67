// Pictures through dielectrics and the media inside them, with their closed forms.
#include <gtest/gtest.h>

#include "integrators/boundary.h"
#include "materials/dispersion.h"
#include "tests/integrators/support/render.h"
#include "tests/integrators/support/shapes.h"
#include "tests/support/block_test.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// Clear glass of an index; with an absorption per metre grey.
Material make_glass(float ior, float absorption = 0, float roughness = 0, int priority = 0) {
  Material m;
  m.metallic = 0;
  m.roughness = roughness;
  m.ior = ior;
  m.priority = priority;
  m.transmission = Transmission{.factor = 1, .texture = {}};
  m.volume = Volume{.thickness = 1, .attenuation_color = {1, 1, 1}, .attenuation_distance = 0};
  if (absorption > 0) {
    m.volume->attenuation_color = Rgb(std::exp(-absorption));
    m.volume->attenuation_distance = 1;
  }
  return m;
}

Material make_thin_glass(float ior) {
  Material m = make_glass(ior);
  m.volume.reset();
  return m;
}

double reflectance(double n1, double n2) { return (n1 - n2) * (n1 - n2) / ((n1 + n2) * (n1 + n2)); }

/// A square of half side `half` around the centre that emits 1 upwards and reflects nothing.
void add_emitter(Scene& scene, const Vec3f& center, float half) {
  add_mesh(scene, make_quad(center, {half, 0, 0}, {0, 0, -half}),
           add_material(scene, make_emitter({1, 1, 1})));
}

void add_slab(Scene& scene, const Material& material, float bottom, float top) {
  add_mesh(scene, make_box({-40, bottom, -40}, {40, top, 40}), add_material(scene, material));
}

Mean probe(const Scene& scene, int spp = 256, Strategy strategy = Strategy::bsdf, int depth = 100) {
  return mean_of(render(scene, independent_settings(16, 16, std::uint32_t(spp)), with(strategy, depth)), 0);
}

/// Largest deviation of a pixel from 1.
double worst_of(const Picture& p) {
  double worst = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) worst = std::max(worst, std::abs(double(p.at(x, y)[0]) - 1));
  return worst;
}

// Each path brings exactly 1 wherever it leaves, so each pixel is 1. Catches a Fresnel split that does
// not add up, a refraction on the wrong side, and self-hits.
TEST(Glass, IsInvisibleInAFurnace) {
  for (const float ior : {1.0f, 1.1f, 1.5f, 2.4f})
    for (const bool box : {false, true}) {
      Scene scene;
      const int glass = add_material(scene, make_glass(ior));
      Transform turn;
      turn.rotation = Quatf(0.9f, 0.1f, 0.3f, 0.2f).normalized();
      if (box)
        add_mesh(scene, make_box({-0.6f, -0.5f, -0.7f}, {0.6f, 0.5f, 0.7f}), glass, turn);
      else
        add_shape(scene, make_sphere(1), glass);
      scene.environment.radiance = Rgb(1, 1, 1);
      add_eye(scene, {2, 2.5f, 3}, {0, 0, 0}, 0.6f);
      EXPECT_LT(worst_of(render(scene, independent_settings(64, 64, 16), with(Strategy::bsdf, 1000))), 1e-4)
          << ior << box;
    }
}

TEST(Glass, OfAThinWallIsInvisibleInAFurnace) {
  Scene scene;
  add_shape(scene, make_sphere(1), add_material(scene, make_thin_glass(1.5f)));
  scene.environment.radiance = Rgb(1, 1, 1);
  add_eye(scene, {2, 2.5f, 3}, {0, 0, 0}, 0.6f);
  EXPECT_LT(worst_of(render(scene, independent_settings(64, 64, 16), with(Strategy::bsdf, 1000))), 1e-4);
}

// A coarse mesh with interpolated normals: where they would reflect or refract to the wrong side of
// the triangle something is lost; how much is bounded here.
TEST(Glass, OfACoarseMeshLosesLittleInAFurnace) {
  Scene scene;
  add_mesh(scene, make_uv_sphere({0, 0, 0}, 1, 8), add_material(scene, make_glass(1.5f)));
  scene.environment.radiance = Rgb(1, 1, 1);
  add_probe(scene, {0, 0, 0}, normalize(Vec3f(1, 0.4f, 2)), 5, 0.8f);
  const Mean mean = probe(scene, 256, Strategy::bsdf, 1000);
  EXPECT_LT(mean.value, 1 + 4.5 * mean.error + 1e-5);
  EXPECT_GT(mean.value, 0.97);
}

/// Polarised light apart, as the renderer has it: reflectance at an angle.
double reflectance_at(double cosine, double n) {
  const double t = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
  const double s = (cosine - n * t) / (cosine + n * t), p = (n * cosine - t) / (n * cosine + t);
  return 0.5 * (s * s + p * p);
}

// Catches a missing internal reflection, and an absorption over the thickness instead of the path.
TEST(Slab, TransmitsWhatTheSeriesOfReflectionsLeaves) {
  const double degrees[] = {0, 60};
  for (const double angle : degrees)
    for (const float absorption : {0.0f, 1.0f}) {
      const double cosine = std::cos(angle * std::numbers::pi / 180), sine = std::sqrt(1 - cosine * cosine);
      Scene scene;
      add_slab(scene, make_glass(1.5f, absorption), 0, 1);
      add_emitter(scene, {0, -1, 0}, 200);
      add_probe(scene, {0, 1, 0}, Vec3f(float(sine), float(cosine), 0), 3, 1e-3f);
      const double f = reflectance_at(cosine, 1.5), inside = std::sqrt(1 - sine * sine / 2.25);
      const double tau = std::exp(-absorption / inside);
      const double truth = (1 - f) * (1 - f) * tau / (1 - f * f * tau * tau);
      if (absorption == 0) {
        EXPECT_NEAR(truth, angle == 0 ? 0.923077 : 0.836232, 1e-5);
      }
      EXPECT_TRUE(mean_is(probe(scene, 3072), truth, 0.01)) << angle << " " << absorption;
    }
}

TEST(Slab, ReflectsBothOfItsFaces) {
  Scene scene;
  add_slab(scene, make_glass(1.5f, 1), 0, 1);
  add_mesh(scene, make_quad({0, -1, 0}, {200, 0, 0}, {0, 0, -200}),
           add_material(scene, make_lambert({0, 0, 0})));
  scene.environment.radiance = Rgb(1, 1, 1);
  add_probe(scene, {0, 1, 0}, {0, 1, 0}, 3, 1e-3f);
  EXPECT_TRUE(mean_is(probe(scene, 1024), 0.044990, 0.05));
}

TEST(AbsorbingSphere, TakesWhatItsChordTakes) {
  for (const float impact : {0.0f, 0.8f}) {
    Scene scene;
    add_shape(scene, make_sphere(1), add_material(scene, make_glass(1.5f, 0.5f)));
    scene.environment.radiance = Rgb(1, 1, 1);
    add_probe(scene, {impact, 0, 0}, {0, 0, 1}, 5, 1e-3f);
    EXPECT_TRUE(mean_is(probe(scene, 1536), impact == 0 ? 0.384101 : 0.450793, 0.01)) << impact;
  }
}

// Radiance is n^2 times as large inside: a furnace cannot see that.
TEST(Camera, InsideGlassSeesRadianceScaled) {
  Scene scene;
  add_slab(scene, make_glass(1.5f), -5, 5);
  scene.environment.radiance = Rgb(1, 1, 1);
  add_probe(scene, {0, 0, 0}, {0, -1, 0}, 1, 1e-3f);
  EXPECT_TRUE(mean_is(probe(scene, 256, Strategy::bsdf, 1), 2.16, 0.02));
}

TEST(Emitter, InsideGlassLeavesWithRadianceScaled) {
  Scene scene;
  add_shape(scene, make_sphere(2), add_material(scene, make_glass(1.5f)));
  add_shape(scene, make_sphere(1), add_material(scene, make_emitter({1, 1, 1})));
  add_probe(scene, {0, 0, 0}, {0, 0, 1}, 5, 1e-3f);
  EXPECT_TRUE(mean_is(probe(scene, 64), 0.426667, 0.01));
}

/// Radiance of an emitter inside the last of three media, seen along their common normal.
double seen_through(double n1, double n2, double n3) {
  const double r1 = reflectance(n1, n2), r2 = reflectance(n2, n3);
  return (1 - r1) * (1 - r2) / (1 - r1 * r2) * (n1 / n3) * (n1 / n3);
}

enum class Contact { touching, overlapping, gap };

/// Glass on water; the emitter in the lower one of them, the probe above. `glass_below` turns them round.
Scene glass_and_water(Contact contact, bool glass_below) {
  Scene scene;
  const float water_end = contact == Contact::touching ? 0 : contact == Contact::overlapping ? 0.2f : -0.01f;
  const float flip = glass_below ? -1.0f : 1.0f;
  const auto slab = [&](const Material& m, float a, float b) {
    add_slab(scene, m, std::min(a * flip, b * flip), std::max(a * flip, b * flip));
  };
  slab(make_glass(1.5f, 0, 0, 1), 0, 1);
  slab(make_glass(1.33f), -1, water_end);
  add_emitter(scene, {0, glass_below ? -0.6f : -0.5f, 0}, 30);
  add_probe(scene, {0, 1, 0}, {0, 1, 0}, 3, 1e-3f);
  return scene;
}

// Touching exactly, or overlapping where the glass has priority: the same two interfaces. A gap is
// seen as one. Catches an interface with air in between, and a ray that skips the second of two surfaces in
// one place and believes to be in the wrong medium from there on.
TEST(NestedDielectrics, MeetWithoutAir) {
  EXPECT_NEAR(seen_through(1, 1.5, 1.33) * 1.33 * 1.33, 0.956674, 1e-5);
  for (const Contact contact : {Contact::touching, Contact::overlapping})
    for (const bool glass_below : {false, true}) {
      const double truth = glass_below ? seen_through(1, 1.33, 1.5) : seen_through(1, 1.5, 1.33);
      EXPECT_TRUE(mean_is(probe(glass_and_water(contact, glass_below), 512), truth, 0.005))
          << int(contact) << glass_below;
    }
  const Mean gap = probe(glass_and_water(Contact::gap, false), 512);
  EXPECT_TRUE(mean_is(gap, 0.905959 / (1.33 * 1.33), 0.01));
}

// Three bodies of each kind inside one another: the ray knows what it is in on its way in and out.
TEST(NestedDielectrics, SpheresInSpheresAreInvisibleInAFurnace) {
  Scene scene;
  add_shape(scene, make_sphere(2), add_material(scene, make_glass(1.5f)));
  add_shape(scene, make_sphere(1.5f), add_material(scene, make_glass(1.33f)));
  add_mesh(scene, make_uv_sphere({0, 0, 0}, 0.8f, 16), add_material(scene, make_glass(1.0f)));
  scene.environment.radiance = Rgb(1, 1, 1);
  add_eye(scene, {2, 2.5f, 6}, {0, 0, 0}, 0.8f);
  const Picture p = render(scene, independent_settings(64, 64, 64), with(Strategy::bsdf, 1000));
  EXPECT_NEAR(mean_of(p, 0).value, 1, 0.01);
}

// A surface in the same place that is no boundary hides it, whichever of the two the ray reports.
TEST(NestedDielectrics, WaterOnAGlowingFloorShowsTheFloor) {
  Scene scene;
  add_slab(scene, make_glass(1.33f), 0, 1);
  add_emitter(scene, {0, 0, 0}, 50);
  add_probe(scene, {0, 1, 0}, {0, 1, 0}, 3, 1e-3f);
  EXPECT_TRUE(mean_is(probe(scene, 128), (1 - reflectance(1, 1.33)) / (1.33 * 1.33), 0.01));
}

// Where it overlaps something of higher priority, water is not there: neither its surface nor its colour.
TEST(NestedDielectrics, LowPriorityIsNotThere) {
  for (const int priority : {-1, 1}) {
    Scene scene;
    add_slab(scene, make_glass(1.0f), 0, 2);
    add_slab(scene, make_glass(1.0f, 1, 0, priority), 0.5f, 1.5f);
    add_emitter(scene, {0, -1, 0}, 200);
    add_probe(scene, {0, 3, 0}, {0, 1, 0}, 3, 1e-3f);
    EXPECT_TRUE(mean_is(probe(scene, 256), priority > 0 ? std::exp(-1.0) : 1.0, 0.03)) << priority;
  }
}

/// Rough glass before a lamp, over a floor.
Scene rough_glass(float absorption) {
  Scene scene;
  add_shape(scene, make_sphere(1), add_material(scene, make_glass(1.5f, absorption, 0.5f)),
            translate({0, 1, 0}));
  add_mesh(scene, make_quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}), add_material(scene, make_lambert(Rgb(0.6f))));
  add_light(scene, make_area_light(LightKind::rectangle, 5, 2, 2),
            look_along({2, 4, 1}, normalize(Vec3f(-0.5f, -0.8f, -0.2f))));
  add_eye(scene, {0, 2, 5}, {0, 1, 0}, 0.8f);
  return scene;
}

// The strategies agree through rough interfaces: eval, sample and density of both sides, and the
// scale and absorption of light that is sampled across them.
TEST(RoughGlass, StrategiesAgree) {
  for (const float absorption : {0.0f, 0.7f}) {
    const Scene scene = rough_glass(absorption);
    const auto settings = independent_settings(32, 32, 512);
    const Mean mis = mean_of(render(scene, settings, with(Strategy::mis, 6)), 0);
    auto other = settings;
    other.seed = 2;
    EXPECT_TRUE(means_agree(mean_of(render(scene, other, with(Strategy::light, 6)), 0), mis, 0.04));
    other.seed = 3;
    EXPECT_TRUE(means_agree(mean_of(render(scene, other, with(Strategy::bsdf, 6)), 0), mis, 0.08));
  }
}

// A lamp and a floor inside an absorbing medium: light that is sampled is absorbed as light that is hit.
TEST(AbsorbingMedium, StrategiesAgreeInsideIt) {
  Scene scene = rough_glass(0);
  add_shape(scene, make_flat_shape(ShapeKind::box, {20, 20, 20}),
            add_material(scene, make_glass(1.0f, 0.2f, 0, -1)));
  const auto settings = independent_settings(32, 32, 512);
  const Mean mis = mean_of(render(scene, settings, with(Strategy::mis, 6)), 0);
  auto other = settings;
  other.seed = 2;
  EXPECT_TRUE(means_agree(mean_of(render(scene, other, with(Strategy::light, 6)), 0), mis, 0.07));
  EXPECT_LT(mis.value, 0.7 * mean_of(render(rough_glass(0), settings, with(Strategy::mis, 6)), 0).value);
}

// Catches 0 times infinity, for a colour of 0 and for a ray that never ends, and a colour of 0 that is taken
// for a small one: half of the light would be left after a hundredth of the distance.
TEST(AbsorbingMedium, LeavesNothingOfABlackChannelAndAllOfAWhiteOne) {
  Material m = make_glass(1.5f);
  m.volume->attenuation_color = {0, 0.25f, 1};
  m.volume->attenuation_distance = 2;
  const Medium medium = make_medium(m);
  EXPECT_EQ(transmittance(&medium, 0), Rgb(1, 1, 1));
  EXPECT_EQ(transmittance(&medium, 1e-6f).x, 0);
  EXPECT_NEAR(transmittance(&medium, 1).y, 0.5, 1e-6);
  EXPECT_EQ(transmittance(&medium, 1e6f), Rgb(0, 0, 1));
  EXPECT_EQ(transmittance(&medium, kInfinity), Rgb(0, 0, 1));
}

TEST(Dispersion, OfAClearSphereIsWhiteInAFurnace) {
  Scene scene;
  Material glass = make_glass(1.6f);
  glass.dispersion = 1;
  add_shape(scene, make_sphere(1), add_material(scene, glass));
  scene.environment.radiance = Rgb(1, 1, 1);
  add_probe(scene, {0, 0, 0}, {0, 0, 1}, 5, 0.7f);
  const Picture p = render(scene, independent_settings(32, 32, 256), with(Strategy::bsdf, 1000));
  for (int k = 0; k < 3; ++k) EXPECT_TRUE(mean_is(mean_of(p, k), 1, 0.02)) << k;
}

// A prism bends each wavelength by its own index: what leaves it in the direction of one line is that line.
TEST(Dispersion, IndexFollowsTheAbbeNumber) {
  const Medium medium{1.6f, 20 / 30.0f, Rgb(0), 0};
  EXPECT_NEAR(eval_ior(medium, 587.6f), 1.6, 1e-6);
  EXPECT_EQ(eval_ior(medium, 0), 1.6f);
  EXPECT_NEAR(0.6 / (eval_ior(medium, 486.1f) - eval_ior(medium, 656.3f)), 30, 1e-3);
  EXPECT_GT(eval_ior(medium, 400), eval_ior(medium, 700));
}

TEST(Dispersion, WavelengthsAreWhiteTogether) {
  TestRandom random(1);
  Rgb sum(0, 0, 0);
  constexpr int kSamples = 200000;
  for (int i = 0; i < kSamples; ++i) {
    const float u = random.next1();
    const WavelengthSample s = sample_wavelength(u, random.next2());
    ASSERT_TRUE(s.wavelength > 330 && s.wavelength < 780);
    ASSERT_NEAR(s.weight.x + s.weight.y + s.weight.z, 3, 1e-4);
    sum += s.weight;
  }
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(sum[k] / kSamples, 1, 0.01);
}

}  // namespace
}  // namespace parian
