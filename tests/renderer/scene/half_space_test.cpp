#include "renderer/scene/half_space.h"

#include <gtest/gtest.h>

#include "tests/support/half_space_walk.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// Chandrasekhar's H for isotropic scattering by its closed form (Radiative Transfer, chapter V, eq. 37 after
/// the substitution of tan t): log H = -mu / pi integral of log(1 - albedo t cot t) / (cos^2 t + mu^2 sin^2
/// t) over t from 0 to pi / 2.
double closed_form_h(double albedo, double mu) {
  constexpr int kSteps = 20000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double t = std::numbers::pi / 2 * (i + 0.5) / kSteps, c = std::cos(t), s = mu * std::sin(t);
    sum += std::log(1 - albedo * t / std::tan(t)) / (c * c + s * s);
  }
  return std::exp(-mu / 2 * sum / kSteps);
}

// Without interface it is 1 - H(1) sqrt(1 - albedo). Catches an H that has not converged.
TEST(HalfSpace, WithoutInterfaceIsChandrasekhars) {
  for (const double albedo : {1e-3, 0.1, 0.5, 0.8, 0.9, 0.99, 0.999})
    EXPECT_NEAR(half_space_reflectance(albedo, 1), 1 - closed_form_h(albedo, 1) * std::sqrt(1 - albedo), 1e-6)
        << albedo;
}

// Random walks gave these. Catches diffusion in place of H (.9 at 1.3: .2992), a lost
// reflection of the interface, and one that does not let out what it does not reflect.
TEST(HalfSpace, BelowAnInterfaceIsWhatWalksGive) {
  const struct {
    double eta, albedo, truth;
  } cases[] = {{1.3, .1, .00823}, {1.3, .5, .0635},  {1.3, .8, .1813},   {1.3, .9, .2906},
               {1.3, .95, .4079}, {1.3, .99, .6565}, {1.3, .999, .8716}, {1.5, .5, .0461},
               {1.5, .8, .1375},  {1.5, .9, .2291},  {1.5, .99, .5856}};
  for (const auto& c : cases)
    EXPECT_NEAR(half_space_reflectance(c.albedo, c.eta), c.truth, 2e-3 * c.truth + 1e-4)
        << c.eta << " " << c.albedo;
}

// Materials as measured by Jensen et al. 2001, their table, in 1 / mm: what their walks reflect.
TEST(HalfSpace, OfMeasuredMaterials) {
  const struct {
    double eta, scattering[3], absorption[3], truth[3];
  } materials[] = {{1.5, {2.19, 2.62, 3.00}, {.0021, .0041, .0071}, {.839, .800, .761}},   // marble
                   {1.3, {.74, .88, 1.01}, {.032, .17, .48}, {.440, .214, .116}},          // skin1
                   {1.3, {.18, .07, .03}, {.061, .97, 1.45}, {.148, .0054, .0016}},        // ketchup
                   {1.3, {2.55, 3.21, 3.77}, {.0011, .0024, .014}, {.913, .887, .770}},    // whole milk
                   {1.3, {7.38, 5.47, 3.15}, {.0002, .0028, .0163}, {.978, .905, .737}}};  // cream
  for (const auto& m : materials)
    for (int k = 0; k < 3; ++k) {
      const double albedo = m.scattering[k] / (m.scattering[k] + m.absorption[k]);
      EXPECT_NEAR(half_space_reflectance(albedo, m.eta), m.truth[k], std::min(2e-3, 0.04 * m.truth[k]))
          << m.scattering[k];
    }
}

// 2e5 walks: 4.5 standard errors are .005 at most, and 8% of the smallest.
TEST(NightlyHalfSpace, IsWhatWalksGive) {
  for (const double eta : {1.0, 1.3, 1.5, 2.0})
    for (const double albedo : {0.5, 0.8, 0.9, 0.99}) {
      HalfSpaceWalk walk(albedo, eta, 1);
      Statistics out;
      for (int i = 0; i < 200000; ++i) out.add(walk.next() ? 1 : 0);
      EXPECT_TRUE(mean_is(out, half_space_reflectance(albedo, eta), 0.08)) << eta << " " << albedo;
    }
}

TEST(HalfSpace, BlackIsBlackAndWhiteIsWhite) {
  for (const double eta : {1.0, 1.3, 3.0}) {
    EXPECT_EQ(half_space_reflectance(0, eta), 0);
    EXPECT_EQ(half_space_reflectance(1, eta), 1);
    const double nearly = half_space_reflectance(1 - 1e-12, eta);
    EXPECT_TRUE(nearly < 1 && nearly > 1 - 5e-5) << nearly;
    double before = 0;
    for (int i = 1; i <= 100; ++i) {
      const double now = half_space_reflectance(i / 100.0, eta);
      ASSERT_GT(now, before);
      before = now;
    }
  }
}

TEST(HalfSpace, AlbedoIsTheInverse) {
  for (const double eta : {1.0, 1.3, 1.5}) {
    for (const double albedo : {1e-3, 0.1, 0.5, 0.9, 0.99, 0.99999})
      EXPECT_NEAR(half_space_albedo(half_space_reflectance(albedo, eta), eta), albedo, 1e-6) << eta;
    EXPECT_EQ(half_space_albedo(0, eta), 0);
    EXPECT_EQ(half_space_albedo(1, eta), 1);
    EXPECT_EQ(half_space_albedo(1.5, eta), 1);
  }
}

}  // namespace
}  // namespace parian
