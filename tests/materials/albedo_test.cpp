#include "materials/albedo.h"

#include <gtest/gtest.h>

#include "materials/ggx.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

/// a, b and loss by quadrature over the facets seen from wo, each of which reflects G2 / G1: in double
/// precision, by Smith's formulas written down once more.
GgxAlbedo quadrature(double mu, double alpha, int steps = 400) {
  const auto smith = [&](double c) {
    return 0.5 * (std::sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)) - 1);
  };
  const double sine = std::sqrt(std::max(0.0, 1 - mu * mu)), length = std::hypot(sine * alpha, mu);
  const Vec3d warped(sine * alpha / length, 0, mu / length);
  double loss = 0, b = 0;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps / 4; ++i) {
      // Denser in v near 1, where reflections leave for below the horizon.
      const double phi = std::numbers::pi * (i + 0.5) / (steps / 4), t = (j + 0.5) / steps, v = t * (2 - t);
      const double z = (1 - v) * (1 + warped.z) - warped.z, r = std::sqrt(std::max(0.0, 1 - z * z));
      const Vec3d c = Vec3d(r * std::cos(phi), r * std::sin(phi), z) + warped;
      const Vec3d h = Vec3d(c.x * alpha, c.y * alpha, c.z).normalized();
      const double cosine = sine * h.x + mu * h.z, out = 2 * cosine * h.z - mu;
      const double reflected = out > 0 ? (1 + smith(mu)) / (1 + smith(mu) + smith(out)) : 0;
      loss += 2 * (1 - t) * (1 - reflected);
      b += 2 * (1 - t) * reflected * std::pow(std::max(0.0, 1 - cosine), 5);
    }
  const double n = double(steps) * (steps / 4);
  return {float(1 - loss / n - b / n), float(b / n), float(loss / n)};
}

// Off the nodes of the table.
TEST(Albedo, OfGgxIsThatOfQuadrature) {
  for (const float alpha : {1e-4f, 3.3e-4f, 2e-3f, 0.011f, 0.037f, 0.093f, 0.21f, 0.33f, 0.5f, 0.71f, 1.0f})
    for (const float mu : {1.0f, 0.97f, 0.83f, 0.61f, 0.38f, 0.22f, 0.11f, 0.043f, 0.011f, 1e-3f, 1e-4f}) {
      const GgxAlbedo table = ggx_albedo(mu, alpha), truth = quadrature(mu, alpha);
      EXPECT_NEAR(table.loss, truth.loss, 7e-4) << alpha << " at " << mu;
      EXPECT_NEAR(table.b, truth.b, 6e-4) << alpha << " at " << mu;
      EXPECT_NEAR(table.a, truth.a, 8e-4) << alpha << " at " << mu;
    }
}

// By independent computations; the one for alpha 1 is exact.
TEST(Albedo, OfGgxIsWhatIsKnown) {
  const struct {
    float alpha, mu;
    double truth;
  } cases[] = {{0.5f, 1, 0.68785},
               {0.5f, 0.5f, 0.69825},
               {1, 1, 1 - std::log(2.0)},
               {1, 0.5f, 0.45069},
               {0.1f, 1, 0.98830}};
  for (const auto& c : cases) {
    const GgxAlbedo e = ggx_albedo(c.mu, c.alpha);
    EXPECT_NEAR(e.a + e.b, c.truth, 7e-4) << c.alpha << " at " << c.mu;
    EXPECT_NEAR(1 - e.loss, e.a + e.b, 1e-6);
  }
}

// What the compensation divides by is what the furnace sums up, at roughnesses between the rows too; and
// without roughness, Schlick's weight is 1/21 on average.
TEST(Albedo, AveragesAreThoseOfTheTable) {
  for (const float alpha : {0.01f, 0.037f, 0.093f, 0.21f, 0.5f, 0.71f, 1.0f}) {
    const GgxAlbedoRow row = GgxAlbedoRow::make(alpha);
    double loss = 0, b = 0;
    constexpr int kSteps = 100000;
    for (int i = 0; i < kSteps; ++i) {
      const double t = (i + 0.5) / kSteps, mu = t * t * t, weight = 6 * t * t * mu / kSteps;
      const GgxAlbedo e = row.at(float(mu));
      loss += weight * e.loss;
      b += weight * e.b;
    }
    EXPECT_NEAR(row.average_loss / loss, 1, 2e-3) << alpha;
    EXPECT_NEAR(row.average_b, b, 1e-4) << alpha;
    EXPECT_NEAR(row.average_a, 1 - loss - b, 2e-4) << alpha;
  }
  EXPECT_NEAR(GgxAlbedoRow::make(1e-4f).average_b, 1 / 21.0, 1e-4);
}

TEST(Albedo, StaysWithinItsRange) {
  for (const float alpha : {0.0f, 1e-4f, 1e-3f, 0.3f, 1.0f, 2.0f})
    for (const float mu : {0.0f, 1e-6f, 1e-3f, 0.5f, 1.0f, 1.0001f}) {
      const GgxAlbedo e = ggx_albedo(mu, alpha);
      EXPECT_TRUE(e.loss >= 0 && e.b >= 0 && e.a >= -1e-3f && e.loss <= 1 && e.b <= 1) << alpha << " " << mu;
    }
}

}  // namespace
}  // namespace parian
