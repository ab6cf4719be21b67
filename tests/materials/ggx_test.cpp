#include "materials/ggx.h"

#include <gtest/gtest.h>

#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

/// Cells that resolve facet normals: the inmost rings are much narrower than alpha.
SphereCells facet_cells(float alpha) {
  return {.zoom = 0.1 * alpha * alpha, .rings = 30, .sectors = 16, .depth = 5};
}

// The integral of D(h) cos h is 1 (Walter et al. 2007, eq. 4). Catches alpha for alpha^2 and a lost pi.
TEST(Ggx, FacetsCoverTheSurfaceOnce) {
  for (const float alpha : {1e-3f, 1e-2f, 0.1f, 0.5f, 1.0f}) {
    const Ggx ggx{alpha};
    const auto density = [&](const Vec3f& h) { return h.z > 0 ? ggx.d(h) * h.z : 0; };
    EXPECT_NEAR(facet_cells(alpha).integral(density), 1, 1e-4) << alpha;
  }
}

// D(n) = 1 / (pi alpha^2). A form with 1 - cos^2 is 2.6% low at 1e-3 and infinite at 1e-4.
TEST(Ggx, PeakIsExactForSmallAlpha) {
  for (const float alpha : {1e-4f, 1e-3f, 1e-2f, 1.0f}) {
    EXPECT_NEAR(Ggx{alpha}.d({0, 0, 1}) * kPiD * alpha * alpha, 1, 1e-6);
    // At tan(theta) = alpha, D is a quarter of the peak, times cos^-4.
    const double theta = std::atan(double(alpha));
    const Vec3f h(float(std::sin(theta)), 0, float(std::cos(theta)));
    EXPECT_NEAR(Ggx{alpha}.d(h) * kPiD * alpha * alpha * 4 * std::pow(std::cos(theta), 4), 1, 1e-5);
  }
}

// G1 is what makes the facets seen from wo cover cos wo (Heitz 2014, eq. 16). Catches a wrong Lambda.
TEST(Ggx, VisibleFacetsCoverWhatIsSeen) {
  for (const float alpha : {1e-2f, 0.1f, 0.5f, 1.0f})
    for (const float cosine : {1.0f, 0.7f, 0.3f, 0.05f}) {
      const Ggx ggx{alpha};
      const Vec3f wo = at_cosine(cosine);
      const auto visible = [&](const Vec3f& h) {
        return h.z > 0 ? double(ggx.d(h)) * std::max(0.0f, wo.dot(h)) : 0;
      };
      EXPECT_NEAR(facet_cells(alpha).integral(visible) * ggx.g1(wo) / cosine, 1, 1e-3)
          << alpha << " at " << cosine;
    }
}

TEST(Ggx, MaskingIsHeightCorrelated) {
  const Ggx ggx{0.5f};
  const Vec3f wo = at_cosine(0.5f), wi = at_cosine(0.2f, 3);
  // Lambda = (sqrt(1 + alpha^2 tan^2) - 1) / 2 by hand: tan^2 is 3 and 24.
  EXPECT_NEAR(ggx.lambda(wo), 0.5 * (std::sqrt(1.75) - 1), 1e-6);
  EXPECT_NEAR(ggx.g1(wo), 2 / (1 + std::sqrt(1.75)), 1e-6);
  EXPECT_NEAR(ggx.g2(wo, wi), 2 / (std::sqrt(1.75) + std::sqrt(7.0)), 1e-6);
  EXPECT_GT(ggx.g2(wo, wi), ggx.g1(wo) * ggx.g1(wi)) << "the separable form is less";
  EXPECT_EQ(ggx.g1({0, 0, 1}), 1);
}

// Catches a sampler of all normals in place of the visible ones, and a warp that forgets to scale back.
TEST(Ggx, SamplesVisibleNormalsWithTheirDensity) {
  for (const float alpha : {1e-3f, 0.03f, 0.2f, 1.0f})
    for (const float cosine : {1.0f, 0.6f, 0.1f}) {
      const Ggx ggx{alpha};
      const Vec3f wo = at_cosine(cosine);
      TestRandom random(std::uint32_t(cosine * 100 + alpha * 1e6));
      const auto sample = [&]() -> std::optional<Vec3f> {
        return ggx.sample_visible_normal(wo, random.next2());
      };
      const auto pdf = [&](const Vec3f& h) { return h.z > 0 ? ggx.pdf_visible_normal(wo, h) : 0; };
      EXPECT_TRUE(samples_directions(sample, pdf, facet_cells(alpha), 100000, 12, 1))
          << alpha << " at " << cosine;
    }
}

TEST(Ggx, StaysFiniteForSmallAlphaAndGrazingAngles) {
  for (const float alpha : {Ggx::kMinAlpha, 1e-3f, 0.1f, 1.0f})
    for (const float cosine : {1.0f, 0.1f, 1e-2f, 1e-3f, 1e-4f, 1e-6f})
      expect_finite_facets(Ggx{alpha}, cosine);
}

}  // namespace
}  // namespace parian
