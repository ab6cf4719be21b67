#include "materials/anisotropic_ggx.h"

#include <gtest/gtest.h>

#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

constexpr AnisotropicGgx kShapes[] = {{0.5f, 0.1f}, {0.05f, 0.3f}, {1, 0.2f}};

/// Cells that resolve facet normals along the smoother axis.
SphereCells facet_cells(const AnisotropicGgx& ggx) {
  const double alpha = std::min(ggx.alpha_x, ggx.alpha_y);
  return {.zoom = 0.1 * alpha * alpha, .rings = 30, .sectors = 16, .tolerance = 1e-6, .depth = 6};
}

// The integral of D(h) cos h is 1. Catches alpha^2 in place of alpha_x alpha_y.
TEST(AnisotropicGgx, FacetsCoverTheSurfaceOnce) {
  for (const AnisotropicGgx& ggx : kShapes) {
    const auto density = [&](const Vec3f& h) { return h.z > 0 ? ggx.d(h) * h.z : 0; };
    EXPECT_NEAR(facet_cells(ggx).integral(density), 1, 1e-4) << ggx.alpha_x;
  }
}

// G1 is what makes the facets seen from wo cover cos wo (Heitz 2014, eq. 16). Catches a Lambda that mixes up
// the axes.
TEST(AnisotropicGgx, VisibleFacetsCoverWhatIsSeen) {
  for (const AnisotropicGgx& ggx : kShapes)
    for (const float phi : {0.0f, 0.7f, 1.5f})
      for (const float cosine : {0.9f, 0.3f, 0.05f}) {
        const Vec3f wo = at_cosine(cosine, phi);
        const auto visible = [&](const Vec3f& h) {
          return h.z > 0 ? double(ggx.d(h)) * std::max(0.0f, wo.dot(h)) : 0;
        };
        EXPECT_NEAR(facet_cells(ggx).integral(visible) * ggx.g1(wo) / cosine, 1, 1e-3)
            << ggx.alpha_x << " at " << cosine << ", " << phi;
      }
}

TEST(AnisotropicGgx, SamplesVisibleNormalsWithTheirDensity) {
  for (const AnisotropicGgx& ggx : kShapes)
    for (const float phi : {0.3f, 1.4f})
      for (const float cosine : {1.0f, 0.6f, 0.1f}) {
        const Vec3f wo = at_cosine(cosine, phi);
        TestRandom random(std::uint32_t(cosine * 100 + ggx.alpha_x * 1e6f));
        const auto sample = [&]() -> std::optional<Vec3f> {
          return ggx.sample_visible_normal(wo, random.next2());
        };
        const auto pdf = [&](const Vec3f& h) { return h.z > 0 ? ggx.pdf_visible_normal(wo, h) : 0; };
        EXPECT_TRUE(samples_directions(sample, pdf, facet_cells(ggx), 100000, 18, 1))
            << ggx.alpha_x << " at " << cosine << ", " << phi;
      }
}

TEST(AnisotropicGgx, IsGgxWhereTheRoughnessesAreEqual) {
  TestRandom random(1);
  for (int i = 0; i < 10000; ++i) {
    const float alpha = Ggx::kMinAlpha + 0.99f * random.next1();
    const Ggx round{alpha};
    const AnisotropicGgx ggx{alpha, alpha};
    const Vec3f wo = at_cosine(1 - random.next1(), 6 * random.next1());
    const Vec2f u = random.next2();
    const Vec3f h = ggx.sample_visible_normal(wo, u);
    ASSERT_EQ(h, round.sample_visible_normal(wo, u));
    ASSERT_NEAR(ggx.d(h) / round.d(h), 1, 1e-5);
    ASSERT_NEAR(ggx.lambda(wo), round.lambda(wo), 1e-5f * (1 + round.lambda(wo)));
    ASSERT_NEAR(ggx.pdf_visible_normal(wo, h), round.pdf_visible_normal(wo, h),
                1e-5f * round.pdf_visible_normal(wo, h));
    ASSERT_NEAR(ggx.g2(wo, h), round.g2(wo, h), 1e-5f);
  }
}

// Half a turn of the frame and a reflection change nothing; a quarter turn exchanges the axes.
TEST(AnisotropicGgx, AQuarterTurnExchangesTheAxes) {
  const AnisotropicGgx ggx{0.4f, 0.1f}, turned{0.1f, 0.4f};
  const Vec3f w = at_cosine(0.3f, 0.4f), t(-w.y, w.x, w.z);
  EXPECT_FLOAT_EQ(ggx.d(w), turned.d(t));
  EXPECT_FLOAT_EQ(ggx.lambda(w), turned.lambda(t));
  EXPECT_FLOAT_EQ(ggx.d(w), ggx.d({-w.x, w.y, w.z}));
  EXPECT_GT(ggx.lambda(at_cosine(0.3f, 0)), turned.lambda(at_cosine(0.3f, 0)));
}

TEST(AnisotropicGgx, StaysFiniteForSmallAlphaAndGrazingAngles) {
  for (const AnisotropicGgx& ggx : {AnisotropicGgx{Ggx::kMinAlpha, 1}, AnisotropicGgx{0.5f, Ggx::kMinAlpha}})
    for (const float cosine : {1.0f, 0.1f, 1e-3f, 1e-6f}) expect_finite_facets(ggx, cosine);
}

}  // namespace
}  // namespace parian
