#include "materials/radial_profile.h"

#include <gtest/gtest.h>

#include "materials/diffusion.h"
#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"
#include "tests/support/classical_dipole.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr Diffusion kModels[] = {Diffusion::dipole, Diffusion::better_dipole, Diffusion::burley,
                                 Diffusion::photon_beam};

/// In units of a metre, its total as the model has it.
RadialProfile make(Diffusion model, double albedo, double unit = 1) {
  return {make_diffusion(model, albedo, 1.3), unit, diffusion_reflectance(model, albedo, 1.3)};
}

/// The integral of f over the plane between radii, by midpoints of many small rings.
template <class F>
double integrate_plane(const F& f, double from, double to, int steps = 100000) {
  double sum = 0, a = from;
  for (int i = 1; i <= steps; ++i) {
    const double b = from > 0 ? from * std::pow(to / from, i / double(steps)) : to * i / steps;
    sum += std::numbers::pi * (b - a) * (b + a) * f(float((a + b) / 2));
    a = b;
  }
  return sum;
}
constexpr double kInner = 1e-5;  // of no weight inside

// Catches values and masses that are of different scale, and a density that does not integrate to 1.
TEST(RadialProfile, IntegratesToItsTotalAndItsDensityToOne) {
  for (const Diffusion model : kModels)
    for (const double albedo : {0.01, 0.9, 0.999, 1.0}) {
      const RadialProfile p = make(model, albedo);
      const double r = p.max_radius();
      EXPECT_NEAR(integrate_plane([&](float x) { return p.eval(x); }, kInner, r) / p.total(), 1, 1e-4);
      EXPECT_NEAR(integrate_plane([&](float x) { return p.pdf(x); }, kInner, r), 1, 1e-4);
    }
}

// Within .5% where a ring of a thirty-second of an octave has a thousandth of all; the density within 12%.
TEST(RadialProfile, IsTheModel) {
  for (const Diffusion model : kModels)
    for (const double albedo : {0.01, 0.5, 0.9, 0.999, 1.0}) {
      const RadialProfile p = make(model, albedo);
      const auto truth = make_diffusion(model, albedo, 1.3);
      const double total = diffusion_reflectance(model, albedo, 1.3);
      int counted = 0;
      for (double r = 3e-4; r < p.max_radius(); r *= 1.0071) {
        if (2 * std::numbers::pi * r * r * truth(r) / 32 < 1e-3 * total) continue;
        ++counted;
        ASSERT_NEAR(p.eval(float(r)) / truth(r), 1, 5e-3) << int(model) << " " << albedo << " " << r;
        ASSERT_NEAR(p.pdf(float(r)) * total / truth(r), 1, 0.12) << int(model) << " " << albedo << " " << r;
      }
      EXPECT_GT(counted, 300);
    }
}

/// Kolmogorov and Smirnov's: the largest distance between the distributions of samples and of the truth.
template <class Cdf>
double largest_distance(const RadialProfile& p, int samples, const Cdf& cdf) {
  TestRandom random(1);
  std::vector<float> radii;
  for (int i = 0; i < samples; ++i) radii.push_back(p.sample(random.next1()));
  std::ranges::sort(radii);
  double worst = 0;
  for (int i = 0; i < samples; ++i) {
    const double truth = cdf(radii[std::size_t(i)]);
    worst = std::max({worst, std::abs(truth - i / double(samples)), std::abs(truth - (i + 1.0) / samples)});
  }
  return worst;
}

// The critical value for 1e-6; 100,000 samples see a shift of the distribution of .9%.
TEST(RadialProfile, SamplesByTheClosedFormsOfModels) {
  constexpr int kSamples = 100000;
  const double critical = 2.7 / std::sqrt(kSamples);
  for (const double albedo : {0.01, 0.9, 0.999, 1.0}) {
    const DipoleByHand dipole{albedo};
    EXPECT_LT(largest_distance(make(Diffusion::dipole, albedo), kSamples,
                               [&](double r) { return 1 - dipole.beyond(r); }),
              critical)
        << albedo;
    const double total = diffusion_reflectance(Diffusion::burley, albedo, 1.3),
                 d = 1 / (1.85 - total + 7 * std::pow(std::abs(total - 0.8), 3));
    const auto burley = [&](double r) { return 1 - std::exp(-r / d) / 4 - 0.75 * std::exp(-r / (3 * d)); };
    EXPECT_LT(largest_distance(make(Diffusion::burley, albedo), kSamples, burley), critical) << albedo;
  }
}

// Rings whose borders are not the table's. Finds, with a chance of 95%, 1.2% of probability that is
// elsewhere.
TEST(RadialProfile, SamplesWithItsDensity) {
  constexpr int kSamples = 200000, kRings = 60;
  for (const double albedo : {0.01, 0.9, 0.999}) {
    const RadialProfile p = make(Diffusion::photon_beam, albedo);
    const double ratio = std::pow(p.max_radius() / 1e-3, 1.0 / (kRings - 1));
    std::vector<double> observed(kRings, 0), expected(kRings, 0);
    TestRandom random(2);
    for (int i = 0; i < kSamples; ++i) {
      const double r = p.sample(random.next1());
      const double k = r < 1e-3 ? 0 : 1 + std::log(r / 1e-3) / std::log(ratio);
      ++observed[std::size_t(std::min(k, kRings - 1.0))];
    }
    const auto pdf = [&](float r) { return p.pdf(r); };
    for (int k = 0; k < kRings; ++k)
      expected[std::size_t(k)] = kSamples * integrate_plane(pdf, k == 0 ? 0 : 1e-3 * std::pow(ratio, k - 1),
                                                            1e-3 * std::pow(ratio, k), 2000);
    EXPECT_TRUE(chi_square(observed, expected, 3)) << albedo;
  }
}

// The tail of what absorbs nothing falls so slowly that the table ends before.
TEST(RadialProfile, CutsOffATenThousandth) {
  for (const double albedo : {0.01, 0.5, 0.9, 0.99, 0.9999}) {
    const RadialProfile p = make(Diffusion::dipole, albedo);
    const double beyond = DipoleByHand{albedo}.beyond(p.max_radius());
    EXPECT_TRUE(beyond < 1.05e-4 && beyond > 5e-5) << albedo << ": " << beyond;
    EXPECT_NEAR(p.total() / DipoleByHand{albedo}.total(), 1 - beyond, 1e-5);
  }
  const RadialProfile white = make(Diffusion::dipole, 1);
  EXPECT_EQ(white.max_radius(), 16384);
  EXPECT_NEAR(white.total(), 1 - DipoleByHand{1}.beyond(16384), 1e-5);
}

// From 1e-9 to 1e9 metres, at every end of every range.
TEST(RadialProfile, IsFiniteAtAnyScaleAndDistance) {
  for (const Diffusion model : kModels)
    for (const double albedo : {1e-3, 0.9, 1.0})
      for (const double unit : {1e-9, 1e-3, 1.0, 1e9}) {
        const RadialProfile p = make(model, albedo, unit), of_metres = make(model, albedo);
        const float end = p.max_radius();
        for (const float u : {0.0f, 1e-7f, 0.5f, 0.9999f, kBelowOne}) {
          const float r = p.sample(u);
          ASSERT_TRUE(r >= 0 && r <= end);
          ASSERT_NEAR(r / unit, of_metres.sample(u), 1e-5 * of_metres.sample(u));
        }
        for (const float r : {-1.0f, 0.0f, 1e-30f, 1e-4f * end, 0.3f * end, 0.999f * end}) {
          ASSERT_TRUE(std::isfinite(p.eval(r)) && p.eval(r) > 0) << r << " " << unit;
          ASSERT_TRUE(std::isfinite(p.pdf(r)) && p.pdf(r) > 0) << r << " " << unit;
        }
        for (const double x : {1e-5, 0.01, 0.3, 1.01, 2.7}) {  // not where rounding decides between cells
          const float r = float(x * unit), m = float(x);
          ASSERT_NEAR(p.eval(r) * unit * unit / of_metres.eval(m), 1, 1e-5) << x << " " << unit;
          ASSERT_NEAR(p.pdf(r) * unit * unit / of_metres.pdf(m), 1, 1e-5) << x << " " << unit;
        }
        for (const float r : {1.001f * end, 1e30f, kInfinity, std::nanf("")})
          ASSERT_TRUE(p.eval(r) == 0 && p.pdf(r) == 0) << r;
      }
}

TEST(RadialProfile, BlackHasNothingAnywhere) {
  const RadialProfile none{}, zero(make_diffusion(Diffusion::burley, 0, 1.3), 1, 0);
  for (const RadialProfile* p : {&none, &zero}) {
    EXPECT_EQ(p->total(), 0);
    EXPECT_EQ(p->max_radius(), 0);
    EXPECT_EQ(p->eval(0), 0);
    EXPECT_EQ(p->pdf(0), 0);
    EXPECT_EQ(p->sample(0.5f), 0);
  }
}

}  // namespace
}  // namespace parian
