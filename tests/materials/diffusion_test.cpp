#include "materials/diffusion.h"

#include <gtest/gtest.h>

#include <array>

#include "materials/diffusion_models.h"
#include "tests/support/classical_dipole.h"
#include "tests/support/half_space_walk.h"

namespace parian {
namespace {

constexpr Diffusion kModels[] = {Diffusion::dipole, Diffusion::better_dipole, Diffusion::burley,
                                 Diffusion::photon_beam};

/// The integral of R_d over the ring from a to b, by the trapezoidal rule in the logarithm of the radius.
double ring(const std::function<double(double)>& profile, double a, double b, int steps) {
  const double step = std::log(b / a) / steps;
  double sum = 0;
  for (int i = 0; i <= steps; ++i) {
    const double r = a * std::exp(i * step);
    sum += 2 * std::numbers::pi * r * r * profile(r) * step * (i == 0 || i == steps ? 0.5 : 1);
  }
  return sum;
}

// Catches a wrong power of the albedo, a source's depth, a sign, and the closed form itself.
TEST(Diffusion, TotalsAreTheIntegrals) {
  for (const Diffusion model : kModels)
    for (const double eta : {1.0, 1.3, 1.5})
      for (const double albedo : {0.1, 0.5, 0.9, 0.99, 0.999}) {
        const double total = diffusion_reflectance(model, albedo, eta);
        const double sum = ring(make_diffusion(model, albedo, eta), 1e-6, 1e4, 400);
        // Inside a millionth is what a pole has there; single scattering has 48 nodes.
        EXPECT_NEAR(sum / total, 1, model == Diffusion::dipole ? 1e-6 : 1e-5)
            << int(model) << " " << albedo << " " << eta;
      }
}

// Their formula, A by the exact internal reflectance. Catches the polynomial fit (.2986 at .9) and sources
// that are subtracted.
TEST(Diffusion, DipoleHasItsPublishedTotals) {
  const struct {
    double eta, albedo, total;
  } cases[] = {{1.3, .1, .00970}, {1.3, .5, .0745},  {1.3, .8, .1969},   {1.3, .9, .2992},
               {1.3, .95, .4067}, {1.3, .99, .6446}, {1.3, .999, .8640}, {1.5, .9, .2747}};
  for (const auto& c : cases)
    EXPECT_NEAR(diffusion_reflectance(Diffusion::dipole, c.albedo, c.eta), c.total,
                c.total < 0.01 ? 5e-6 : 5.1e-5)
        << c.eta << " " << c.albedo;
}

TEST(Diffusion, DipoleIsAsFarAsItsClosedFormSays) {
  for (const double albedo : {0.1, 0.9, 0.999}) {
    const DipoleByHand truth{albedo};
    const auto profile = make_diffusion(Diffusion::dipole, albedo, 1.3);
    for (const double r : {0.1, 1.0, 5.0, 20.0})
      EXPECT_NEAR(ring(profile, 1e-6, r, 2000) / truth.total(), 1 - truth.beyond(r), 1e-5) << r;
  }
}

// Two exponentials of width d and 3 d: within R are 1 - exp(-R / d) / 4 - 3 exp(-R / 3d) / 4.
TEST(Diffusion, BurleyIsAsFarAsItsClosedFormSays) {
  for (const double albedo : {0.1, 0.9, 0.999}) {
    const double total = half_space_reflectance(albedo, 1.3),
                 d = 1 / (1.85 - total + 7 * std::pow(std::abs(total - 0.8), 3));
    const auto profile = make_diffusion(Diffusion::burley, albedo, 1.3);
    for (const double r : {0.1, 1.0, 5.0})
      EXPECT_NEAR(ring(profile, 1e-6, r, 2000) / total,
                  1 - std::exp(-r / d) / 4 - 0.75 * std::exp(-r / (3 * d)), 1e-5)
          << r;
  }
}

// By the depth, as it is derived. Catches the wrong leg of the path, F of the wrong side, and its cosine. And
// without interface the total is albedo / 2 integral of mu / (1 + mu).
TEST(Diffusion, SingleScatteringIsTheIntegralOverTheBeam) {
  for (const double eta : {1.0, 1.3, 1.5})
    for (const double r : {1e-3, 0.1, 1.0, 5.0}) {
      constexpr int kSteps = 40000;
      double sum = 0;
      for (int i = 0; i < kSteps; ++i) {
        const double u = (i + 0.5) / kSteps, depth = r * u / (1 - u), d = std::hypot(r, depth);
        sum += std::exp(-depth - d) * (1 - fresnel_dielectric_exact(depth / d, 1 / eta)) * (depth / d) /
               (d * d) * r / ((1 - u) * (1 - u)) / kSteps;
      }
      EXPECT_NEAR(SingleScattering(0.8, eta)(r) / (0.8 / (4 * std::numbers::pi) * sum), 1, 5e-4)
          << eta << " " << r;
    }
  EXPECT_NEAR(SingleScattering(0.8, 1).total(), 0.4 * (1 - std::log(2.0)), 1e-9);
}

// Both are above what is exact by what their authors' diffusion is. Catches albedo where its square belongs
// (1.16 of the better dipole at .9), a lost kappa and a lost single scattering (.84).
TEST(Diffusion, BetterModelsAreSomePercentAboveTheExactTotal) {
  const struct {
    double albedo, better, beam;
  } cases[] = {{.9, 1.071, 1.061}, {.95, 1.084, 1.054}, {.99, 1.092, 1.046}, {.999, 1.084, 1.039}};
  for (const auto& c : cases) {
    const double exact = half_space_reflectance(c.albedo, 1.3);
    EXPECT_NEAR(diffusion_reflectance(Diffusion::better_dipole, c.albedo, 1.3) / exact, c.better, 1e-3);
    EXPECT_NEAR(diffusion_reflectance(Diffusion::photon_beam, c.albedo, 1.3) / exact, c.beam, 1e-3);
  }
}

TEST(Diffusion, IsFiniteForEveryAlbedoAndDistance) {
  for (const Diffusion model : kModels)
    for (const double eta : {1.0, 1.3, 3.0})
      for (const double r : {0.0, 1e-9, 1.0, 1e3, 1e6}) {
        EXPECT_EQ(make_diffusion(model, 0, eta)(r), 0);
        for (const double albedo : {1e-6, 0.5, 1.0}) {
          const double value = make_diffusion(model, albedo, eta)(r);
          EXPECT_TRUE(std::isfinite(value) && value >= 0) << int(model) << " " << albedo << " " << r;
        }
        EXPECT_GT(make_diffusion(model, 1, eta)(std::min(r, 50.0)), 0);
      }
  for (const Diffusion model : kModels) EXPECT_EQ(diffusion_reflectance(model, 0, 1.3), 0);
  EXPECT_NEAR(diffusion_reflectance(Diffusion::dipole, 1, 1.3), 1, 1e-12);
  EXPECT_NEAR(diffusion_reflectance(Diffusion::better_dipole, 1, 1.3), 1.0757, 1e-3);
  EXPECT_NEAR(diffusion_reflectance(Diffusion::photon_beam, 1, 1.3), 1.0354, 1e-3);
}

TEST(Diffusion, MakesProfilesInMetres) {
  for (const Diffusion model : kModels)
    for (const float unit : {1e-9f, 1e-3f, 1e9f}) {
      const float absorption = 0.1f / unit, scattering = 0.9f / unit;
      const RadialProfile plain = make_profile(model, absorption, scattering, 1.3f),
                          scaled = make_profile(model, absorption, scattering, 1.3f, 0.25);
      EXPECT_NEAR(plain.total() / diffusion_reflectance(model, 0.9, 1.3), 1, 1.1e-4);
      EXPECT_NEAR(scaled.total() / 0.25, 1, 1.1e-4);
      const double square = double(unit) * unit;
      EXPECT_NEAR(plain.eval(0.5f * unit) * square / make_diffusion(model, 0.9, 1.3)(0.5), 1, 5e-3);
    }
}

TEST(Diffusion, MakesABlackProfileWhereNothingScatters) {
  for (const float absorption : {0.0f, 1.0f, 1e9f}) {
    const RadialProfile black = make_profile(Diffusion::photon_beam, absorption, 0, 1.3f);
    EXPECT_EQ(black.total(), 0);
    EXPECT_EQ(black.max_radius(), 0);
  }
  EXPECT_NEAR(make_profile(Diffusion::photon_beam, 0, 1e9f, 1.3f).total(), 1.0354, 1e-3);
}

// What comes out of rings, over what comes out of them of random walks (by 2e7 of them, to .3% at most). Of
// the 5e5 here 4.5 standard errors are 8% of the innermost ring and 1.4% of the outermost. The classical
// dipole gives far too little near the beam; that of photon beams is 2 to 8% above the truth everywhere, so
// that scaling to the exact total leaves 3%.
TEST(NightlyDiffusion, IsAsFarFromWalksAsTheModelsAre) {
  constexpr double kAlbedo = 0.99, kEta = 1.3;
  constexpr int kWalks = 500000;
  const struct {
    double from, to, dipole, better, burley, beam;
  } rings[] = {{.01, .03, .031, .931, 1.184, 1.020}, {.03, .1, .112, .855, 1.295, 1.028},
               {.1, .3, .413, .809, 1.481, 1.039},   {.3, 1, 1.146, 1.029, 1.517, 1.056},
               {1, 3, 1.156, 1.210, 1.091, 1.076},   {3, 10, .971, 1.114, .646, 1.028}};
  std::array<double, std::size(rings)> walked{};
  HalfSpaceWalk walk(kAlbedo, kEta, 1);
  for (int i = 0; i < kWalks; ++i)
    if (const auto r = walk.next())
      for (std::size_t k = 0; k < walked.size(); ++k) walked[k] += *r >= rings[k].from && *r < rings[k].to;
  for (std::size_t k = 0; k < walked.size(); ++k) {
    const auto expect = [&](Diffusion model, double ratio) {
      const double share =
          ring(make_diffusion(model, kAlbedo, kEta), rings[k].from, rings[k].to, 200) / (walked[k] / kWalks);
      EXPECT_NEAR(share / ratio, 1, 4.5 / std::sqrt(walked[k]) + 0.015) << int(model) << " " << rings[k].from;
    };
    expect(Diffusion::dipole, rings[k].dipole);
    expect(Diffusion::better_dipole, rings[k].better);
    expect(Diffusion::burley, rings[k].burley);
    expect(Diffusion::photon_beam, rings[k].beam);
  }
}

}  // namespace
}  // namespace parian
