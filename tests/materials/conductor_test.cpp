#include "materials/conductor.h"

#include <gtest/gtest.h>

#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

/// Gold, about.
Conductor gold(float alpha) { return {{.143f, .422f, .965f}, {3.983f, 2.347f, 6.40f}, {alpha}}; }
/// Reflects all: Fresnel's equations give exactly 1 for an index without a real part.
Conductor perfect(float alpha) { return {{0, 0, 0}, {2, 2, 2}, {alpha}}; }

/// Cells around the mirror direction that resolve the lobe there.
SphereCells lobe_cells(const Conductor& lobe, const Vec3f& wo) {
  const double alpha = lobe.ggx.alpha;
  return {.axis = {-wo.x, -wo.y, wo.z},
          .zoom = 0.2 * alpha * alpha,
          .rings = 24,
          .sectors = 12,
          .tolerance = 1e-6,
          .depth = 5};
}

/// Albedo from wo, by quadrature of eval().
double albedo(const Conductor& lobe, float cosine) {
  const Vec3f wo = at_cosine(cosine);
  return lobe_cells(lobe, wo).integral([&](const Vec3f& wi) { return lobe.eval(wo, wi).f_cos.y; });
}

// F D G / (4 cos cos) where the half vector is the normal: D = 1 / (pi alpha^2), by hand.
TEST(Conductor, HasTheRightValueInTheMirrorDirection) {
  const Vec3f n(0, 0, 1);
  EXPECT_NEAR(gold(0.25f).eval(n, n).f_cos.x, .966688 * 1.27324, 1e-5);
  EXPECT_NEAR(gold(0.25f).eval(n, n).f_cos.y, .775845 * 1.27324, 1e-5);
  // At 60 degrees tan^2 is 3: G = 1 / sqrt(1 + 3 alpha^2) = 1 / sqrt(1.75).
  const Vec3f wo = at_cosine(0.5f), wi(-wo.x, -wo.y, wo.z);
  EXPECT_NEAR(gold(0.5f).eval(wo, wi).f_cos.y, .780016 / (kPiD * 0.25) / std::sqrt(1.75) / (4 * 0.5), 1e-5);
  EXPECT_TRUE(is_black(gold(0.5f).eval(wo, -wi).f_cos));
  EXPECT_EQ(gold(0.5f).eval(wo, -wi).pdf, 0);
}

// F is taken at the half vector, not at the normal.
TEST(Conductor, ReflectanceIsThatOfTheFacet) {
  for (const float alpha : {0.1f, 0.5f}) {
    const Vec3f wo = at_cosine(0.3f, 0), wi = at_cosine(0.8f, 2), h = normalize(wo + wi);
    const float white = perfect(alpha).eval(wo, wi).f_cos.x;
    EXPECT_NEAR(gold(alpha).eval(wo, wi).f_cos.x / white, fresnel_conductor(wo.dot(h), .143f, 3.983f), 1e-5);
  }
}

TEST(Conductor, AlbedoWithoutLossIsThatOfGgx) {
  for (const GgxTruth& c : kGgxTruths) {
    EXPECT_NEAR(albedo(perfect(c.alpha), c.cosine), c.albedo, 1e-4) << c.alpha << " at " << c.cosine;
    EXPECT_TRUE(mean_is(sampled_albedo(perfect(c.alpha), c.cosine, 200000), c.albedo, 0.012))
        << c.alpha << " at " << c.cosine;
  }
}

TEST(Conductor, WeightsAverageToTheIntegral) {
  for (const float alpha : {0.001f, 0.05f, 0.3f, 1.0f})
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
      const Statistics s = sampled_albedo(gold(alpha), cosine, 100000);
      EXPECT_NEAR(s.mean(), albedo(gold(alpha), cosine), 4.5 * s.standard_error() + 3e-4)
          << alpha << " at " << cosine;
    }
}

// A rough metal tends to the mirror.
TEST(Conductor, NarrowLobesReflectAsTheMirror) {
  for (const float cosine : {1.0f, 0.5f, 0.1f})
    EXPECT_NEAR(sampled_albedo(gold(2 * Ggx::kMinAlpha), cosine, 10000).mean(),
                fresnel_conductor(cosine, .422f, 2.347f), 1e-3)
        << cosine;
}

TEST(Conductor, MirrorIsFoundBySamplingOnly) {
  for (const float alpha : {0.0f, 0.5f * Ggx::kMinAlpha})
    for (const float cosine : {1.0f, 0.5f, 1e-4f}) {
      const Conductor lobe = gold(alpha);
      const Vec3f wo = at_cosine(cosine), wi(-wo.x, -wo.y, wo.z);
      const auto s = lobe.sample(wo, 0.5f, {0.2f, 0.9f});
      ASSERT_TRUE(s);
      EXPECT_EQ(s->wi, wi);
      EXPECT_EQ(s->pdf, kInfinity);
      EXPECT_EQ(s->weight, fresnel_conductor(cosine, lobe.eta, lobe.k));
      EXPECT_EQ(lobe.eval(wo, wi).pdf, 0);
      EXPECT_TRUE(is_black(lobe.eval(wo, wi).f_cos));
    }
  EXPECT_NEAR(gold(0).sample({0, 0, 1}, 0, {0, 0})->weight.y, .775845, 1e-6);
  EXPECT_FALSE(gold(Ggx::kMinAlpha).is_mirror());
}

// Nothing but finite, non-negative numbers down to a mirror and to a viewer at the horizon, for metals
// with and without loss, and for an index of air.
TEST(Conductor, StaysFiniteForSmallAlphaAndGrazingAngles) {
  TestRandom random(4);
  for (const float alpha : {0.0f, Ggx::kMinAlpha, 1e-3f, 1e-2f, 0.1f, 1.0f})
    for (const float cosine : {1.0f, 0.1f, 1e-2f, 1e-3f, 1e-4f, 1e-6f})
      for (const auto& lobe : {gold(alpha), perfect(alpha), Conductor{{1, 1.5f, 0.5f}, {0, 0, 0}, {alpha}}}) {
        const Vec3f wo = at_cosine(cosine);
        for (int i = 0; i < 2000; ++i) {
          const float corners[] = {0, 0.5f, kBelowOne};
          const Vec2f u = i < 9 ? Vec2f(corners[i / 3], corners[i % 3]) : random.next2();
          const BsdfValue value = lobe.eval(wo, random.next1() < 0.5f ? wo : at_cosine(random.next1(), 4));
          ASSERT_TRUE(is_finite(value.f_cos) && value.f_cos.x >= 0 && std::isfinite(value.pdf) &&
                      value.pdf >= 0);
          const auto s = lobe.sample(wo, 0, u);
          if (!s) continue;
          ASSERT_TRUE(is_finite(s->wi) && is_finite(s->weight) && s->pdf > 0) << alpha << " at " << cosine;
          ASSERT_TRUE(std::isfinite(s->pdf) || lobe.is_mirror());
          for (int k = 0; k < 3; ++k) ASSERT_TRUE(s->weight[k] >= 0 && s->weight[k] <= 1 + 1e-5f);
        }
      }
}

}  // namespace
}  // namespace parian
