// The random walk in bodies that scatter light, against exact values.
#include "integrators/random_walk.h"

#include <gtest/gtest.h>

#include "renderer/scene/half_space.h"
#include "tests/integrators/support/bodies.h"
#include "tests/integrators/support/render.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

Picture walked(const Scene& scene, int spp, int side = 16) {
  return render(scene, independent_settings(side, side, std::uint32_t(spp)), with(Subsurface::random_walk));
}

// Kolmogorov and Smirnov's test, critical value for 1e-6; 40,000 samples see a shift of the distribution
// function of 1.4%. The mean cosine is g.
TEST(HenyeyGreenstein, IsSampledByItsDistribution) {
  TestRandom random(1);
  for (const float g : {-0.99f, -0.5f, -1e-3f, 0.0f, 5e-4f, 2e-3f, 0.3f, 0.9f, 0.99f}) {
    constexpr int kSamples = 40000;
    const Vec3f d = random.direction();
    std::vector<double> cosines;
    Statistics mean;
    for (int i = 0; i < kSamples; ++i) {
      const Vec3f w = sample_henyey_greenstein(d, g, random.next2());
      ASSERT_NEAR(w.length(), 1, 1e-5);
      cosines.push_back(w.dot(d));
      mean.add(w.dot(d));
    }
    std::ranges::sort(cosines);
    const double e = g;
    double worst = 0;
    for (int i = 0; i < kSamples; ++i) {
      // The integral of the phase function from -1 to x.
      const double x = std::clamp(cosines[std::size_t(i)], -1.0, 1.0);
      const double cdf =
          e == 0 ? (1 + x) / 2 : (1 - e * e) / (2 * e) * (1 / std::sqrt(1 + e * e - 2 * e * x) - 1 / (1 + e));
      worst =
          std::max({worst, std::abs(cdf - i / double(kSamples)), std::abs(cdf - (i + 1) / double(kSamples))});
    }
    EXPECT_LT(worst * std::sqrt(kSamples), 2.7) << g;
    EXPECT_NEAR(mean.mean(), g, 4.5 * mean.standard_error() + 1e-6) << g;
  }
}

// What absorbs nothing gives back all, whatever its shape, index, phase function and roughness. Catches a
// wrong weight of a piece and a lost path.
TEST(Walk, LosesNothingInAFurnaceWhereNothingAbsorbs) {
  for (const float ior : {1.0f, 1.3f, 1.5f})
    for (const float g : {0.0f, 0.8f}) {
      Scene scene;
      Material m = make_dense(Rgb(0, 0, 0), Rgb(0.5f, 2, 5), ior);
      if (g > 0) {
        m.subsurface.reset();
        m.metallic = 0;
        m.transmission = Transmission{.factor = 1, .texture = {}};
        m.volume =
            Volume{.thickness = 1, .attenuation_color = {0.4f, 0.1f, 0.01f}, .attenuation_distance = 1};
        m.scatter = VolumeScatter{.multiscatter_color = {1, 1, 1}, .anisotropy = g};
      }
      add_shape(scene, make_sphere(1), add_material(scene, m));
      set_white_sky(scene);
      add_probe(scene, {0, 0, 0}, normalize(Vec3f(1, 0.4f, 2)), 5, 0.9f);
      const Picture p = walked(scene, 256);
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(mean_is(mean_of(p, k), 1, 0.02)) << ior << " " << g << " " << k;
    }
}

// A thick block gives back what the exact solution for a half-space says. Each channel has an albedo of its
// own, so that channels which are weighed wrongly are seen.
TEST(Walk, OfAThickBlockIsThatOfAHalfSpace) {
  for (const float ior : {1.0f, 1.3f, 1.5f}) {
    Scene scene;
    const Rgb albedo(0.5f, 0.9f, 0.99f), extinction(1, 0.5f, 2);
    add_block(scene, make_dense((Rgb(1, 1, 1) - albedo) * extinction, albedo * extinction, ior), 200);
    set_white_sky(scene);
    add_probe_above(scene, {0, 0, 0});
    const Picture p = walked(scene, 512);
    for (int k = 0; k < 3; ++k) {
      const double truth = seen(ior, half_space_reflectance(albedo[k], ior));
      EXPECT_TRUE(mean_is(mean_of(p, k), truth, 0.012 / truth)) << ior << " " << k;
    }
  }
}

// A mean free path of 32 times the offset by which rays leave a surface of this size: those that start below
// it have come some way already. Without that it is 1.5% too dark.
TEST(Walk, IsRightNearTheLimitOfResolution) {
  Scene scene;
  const float unit = 32 * plane_offset(1);
  add_block(scene, make_dense(Rgb(0.1f / unit), Rgb(0.9f / unit), 1.3f), 1, 1);
  set_white_sky(scene);
  add_probe_above(scene, {0, 0, 0}, 1e-5f);
  EXPECT_TRUE(mean_is(mean_of(walked(scene, 1024), 0), seen(1.3, half_space_reflectance(0.9, 1.3)), 0.015));
}

struct SlabCase {
  float thickness;
  double reflected, transmitted;
};

// Of light that entered at normal incidence, albedo .99, index 1.3, by an independent Monte Carlo program
// with a standard error of .001.
TEST(Walk, OfASlabReflectsAndTransmitsAsItShould) {
  for (const SlabCase& slab : {SlabCase{1, 0.314, 0.655}, {5, 0.593, 0.253}, {10, 0.646, 0.101}})
    for (const bool above : {true, false}) {
      Scene scene;
      add_block(scene, make_dense(0.99f, 1.3f), slab.thickness);
      set_half_sky(scene, above);
      add_probe_above(scene, {0, 0, 0});
      const double f0 = normal_reflectance(1.3);
      const double truth = above ? f0 + (1 - f0) * slab.reflected : (1 - f0) * slab.transmitted;
      const Mean mean = mean_of(walked(scene, 256), 0);
      EXPECT_NEAR(mean.value, truth, 4.5 * std::hypot(mean.error, 0.001)) << slab.thickness << " " << above;
      EXPECT_LT(4.5 * mean.error, 0.015);
    }
}

// The measured materials of Jensen, Marschner, Levoy and Hanrahan 2001 (per millimetre, which is a metre
// here), against random walks of an independent program with a standard error of .001 at most. A million
// paths see .003 of the light.
TEST(NightlyWalk, OfMeasuredMaterialsGivesBackWhatOtherWalksDo) {
  const struct {
    const char* name;
    Rgb scattering, absorption;
    float ior;
    Rgb given_back;
  } materials[] = {
      {"apple", {2.29f, 2.39f, 1.97f}, {.0030f, .0034f, .046f}, 1.3f, {.855f, .850f, .536f}},
      {"chicken1", {.15f, .21f, .38f}, {.015f, .077f, .19f}, 1.3f, {.306f, .139f, .111f}},
      {"chicken2", {.19f, .25f, .32f}, {.018f, .088f, .20f}, 1.3f, {.315f, .144f, .093f}},
      {"cream", {7.38f, 5.47f, 3.15f}, {.0002f, .0028f, .0163f}, 1.3f, {.978f, .905f, .737f}},
      {"ketchup", {.18f, .07f, .03f}, {.061f, .97f, 1.45f}, 1.3f, {.148f, .0054f, .0016f}},
      {"marble", {2.19f, 2.62f, 3.00f}, {.0021f, .0041f, .0071f}, 1.5f, {.839f, .800f, .761f}},
      {"potato", {.68f, .70f, .55f}, {.0024f, .0090f, .12f}, 1.3f, {.775f, .623f, .197f}},
      {"skimmilk", {.70f, 1.22f, 1.90f}, {.0014f, .0025f, .0142f}, 1.3f, {.823f, .824f, .694f}},
      {"skin1", {.74f, .88f, 1.01f}, {.032f, .17f, .48f}, 1.3f, {.440f, .214f, .116f}},
      {"skin2", {1.09f, 1.59f, 1.79f}, {.013f, .070f, .145f}, 1.3f, {.635f, .436f, .339f}},
      {"spectralon", {11.6f, 20.4f, 14.9f}, {0, 0, 0}, 1.3f, {1, 1, 1}},
      {"wholemilk", {2.55f, 3.21f, 3.77f}, {.0011f, .0024f, .014f}, 1.3f, {.913f, .887f, .770f}}};
  for (const auto& m : materials) {
    Scene scene;
    add_block(scene, make_dense(m.absorption, m.scattering, m.ior), 300, 300);
    set_white_sky(scene);
    add_probe_above(scene, {0, 0, 0});
    const Picture p = walked(scene, 256, 64);
    for (int k = 0; k < 3; ++k) {
      const Mean mean = mean_of(p, k);
      const double f0 = normal_reflectance(m.ior), given_back = (mean.value - f0) / (1 - f0);
      EXPECT_NEAR(given_back, m.given_back[k], 0.002 + 4.5 * mean.error) << m.name << " " << k;
      EXPECT_LT(4.5 * mean.error, 0.006) << m.name << " " << k;
    }
  }
}

// Scattering that is not isotropic, but alike after similarity, gives back nearly the same of a thick body.
TEST(Walk, FollowsSimilarity) {
  for (const float g : {-0.3f, 0.5f}) {
    Scene scene;
    Material m;
    m.metallic = 0;
    m.roughness = 0;
    m.ior = 1;
    m.transmission = Transmission{.factor = 1, .texture = {}};
    m.volume = Volume{.thickness = 1, .attenuation_color = Rgb(std::exp(-1.0f)), .attenuation_distance = 1};
    m.scatter = VolumeScatter{.multiscatter_color = Rgb(0.5f), .anisotropy = g};
    add_block(scene, m, 300);
    set_white_sky(scene);
    add_probe_above(scene, {0, 0, 0});
    const Medium medium = make_medium(m);
    const float s = medium.reduced_scattering().x;
    const double alike = half_space_reflectance(s / (s + medium.absorption.x), 1);
    EXPECT_NEAR(mean_of(walked(scene, 256), 0).value / alike, 1, 0.07) << g;
  }
}

// A mesh whose triangles are wound inside out is the same body.
TEST(Walk, BearsAMeshThatIsInsideOut) {
  std::array<Mean, 2> means;
  for (const bool outwards : {true, false}) {
    Scene scene;
    add_mesh(scene, make_box({-1, -1, -1}, {1, 1, 1}, outwards), add_material(scene, make_dense(0.9f, 1.3f)));
    set_white_sky(scene);
    add_probe(scene, {0, 0, 0}, normalize(Vec3f(1, 0.4f, 2)), 5, 0.9f);
    means[outwards] = mean_of(walked(scene, 256), 0);
  }
  EXPECT_TRUE(means_agree(means[0], means[1], 0.03));
}

// Media without an end and media without a middle: every render ends and no sample is dropped.
TEST(Walk, EndsAndStaysFiniteInExtremes) {
  for (const float scattering : {0.0f, 1e-6f, 1e9f})
    for (const float absorption : {0.0f, 1e-6f, 1e9f}) {
      Scene scene;
      add_shape(scene, make_sphere(1),
                add_material(scene, make_dense(Rgb(absorption), Rgb(scattering), 1.3f)));
      // Light that goes in never comes out.
      add_mesh(scene, make_quad({0, 0, -2}, {1, 0, 0}, {0, 1, 0}), 0, translate({1.5f, 0, 0}));
      set_white_sky(scene);
      add_probe(scene, {0, 0, 0}, {0, 0, 1}, 5, 2.5f);
      const Mean mean = mean_of(walked(scene, 4, 8), 0);
      EXPECT_GT(mean.value, 0) << scattering << " " << absorption;
      EXPECT_LT(mean.value, 1.3) << scattering << " " << absorption;
    }
}

}  // namespace
}  // namespace parian
