#include "materials/dielectric.h"

#include <gtest/gtest.h>

#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

Dielectric make(float eta, float alpha, bool thin = false) {
  const float r = (eta - 1) / (eta + 1);
  return {eta, Rgb(1, 1, 1), {alpha}, thin, Rgb(r * r), 1};
}

/// Means of the weights of reflected and transmitted samples: the albedos of both sides.
struct Albedo {
  double reflected = 0, transmitted = 0;
};
Albedo albedo(const Dielectric& lobe, const Vec3f& wo, int samples) {
  TestRandom random(5);
  Albedo sum;
  for (int i = 0; i < samples; ++i) {
    const float u = random.next1();
    const auto s = lobe.sample(wo, u, random.next2());
    if (s) (s->wi.z > 0 ? sum.reflected : sum.transmitted) += s->weight.x / samples;
  }
  return sum;
}

// Catches a missing Jacobian, eta for 1 / eta, and a masking of one side only.
TEST(Dielectric, RoughReflectsAndTransmitsWhatQuadratureSays) {
  const Albedo a = albedo(make(1.5f, 0.5f), {0, 0, 1}, 400000);
  EXPECT_NEAR(a.reflected, 0.02817, 0.0006);
  EXPECT_NEAR(a.transmitted, 0.93993, 0.0015);
}

TEST(Dielectric, SmoothLosesNothing) {
  for (const float eta : {0.5f, 0.7f, 1.0f, 1.33f, 1.5f, 2.4f})
    for (const bool thin : {false, true})
      for (const float cosine : {1.0f, 0.5f, 0.05f, 1e-4f}) {
        const Dielectric lobe = make(eta, 0, thin);
        for (const float u : {0.0f, 0.01f, 0.5f, 0.99f}) {
          const auto s = lobe.sample(at_cosine(cosine), u, {0.3f, 0.6f});
          ASSERT_TRUE(s);
          EXPECT_NEAR(s->weight.y, 1, 1e-5);
          EXPECT_EQ(s->pdf, kInfinity);
          EXPECT_NEAR(s->wi.length(), 1, 1e-5);
          if (thin && s->wi.z < 0) {
            EXPECT_LT((s->wi + at_cosine(cosine)).length(), 1e-5) << "straight on";
          }
        }
        EXPECT_TRUE(is_black(lobe.eval(at_cosine(cosine), at_cosine(cosine, 0.7f + kPi)).f_cos));
      }
}

TEST(Dielectric, StaysFiniteAtGrazingAnglesAndSmallRoughness) {
  for (const float eta : {0.4f, 0.999f, 1.001f, 1.5f, 1e6f})
    for (const float alpha : {Ggx::kMinAlpha, 1e-3f, 1.0f})
      for (const float cosine : {1.0f, 1e-2f, 1e-4f}) {
        const Dielectric lobe = make(eta, alpha);
        TestRandom random(3);
        for (int i = 0; i < 500; ++i) {
          const float u = random.next1();
          const auto s = lobe.sample(at_cosine(cosine), u, random.next2());
          if (!s) continue;
          ASSERT_TRUE(s->pdf > 0 && s->pdf < kInfinity);
          ASSERT_TRUE(s->weight.x >= 0 && s->weight.x < 1.01f) << s->weight.x;
          ASSERT_NEAR(s->wi.length(), 1, 1e-4);
        }
      }
}

}  // namespace
}  // namespace parian
