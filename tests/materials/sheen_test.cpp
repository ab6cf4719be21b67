#include "materials/sheen.h"

#include <gtest/gtest.h>

#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

constexpr float kRoughnesses[] = {0.07f, 0.15f, 0.3f, 0.5f, 0.8f, 1.0f};

Sheen white(float roughness) { return {{1, 1, 1}, std::max(Sheen::kMinAlpha, roughness * roughness)}; }

/// Albedo from wo by quadrature, the horizon in detail: mu = t^3, half a turn.
double albedo(const Sheen& sheen, float cosine) {
  const Vec3f wo = at_cosine(cosine, 0);
  const auto f = [&](double t, double phi) {
    return double(sheen.eval(wo, at_cosine(float(t * t * t), float(phi))).f_cos.y) * 3 * t * t;
  };
  return 2 * integrate(f, 0, 1, 0, std::numbers::pi, 1e-6);
}

// The integral of D(h) cos h is 1. Catches 1 / alpha in place of half of it, and a wrong norm.
TEST(Sheen, FacetsCoverTheSurfaceOnce) {
  for (const float roughness : kRoughnesses) {
    const Sheen sheen = white(roughness);
    const auto f = [&](double mu, double) { return double(sheen.d(at_cosine(float(mu)))) * mu; };
    EXPECT_NEAR(2 * std::numbers::pi * integrate(f, 0, 1, 0, 1), 1, 1e-4) << roughness;
  }
}

// D in single precision, next to the same in double. Catches a sine from 1 - cos^2.
TEST(Sheen, IsStableForTheLeastRoughness) {
  const Sheen sheen = white(0);
  for (float mu = 0.001f; mu < 0.3f; mu += 0.01f) {
    const Vec3f h = at_cosine(mu);
    const double sine2 = double(h.x) * h.x + double(h.y) * h.y, exponent = 1 / double(sheen.alpha);
    const double d = (2 + exponent) * std::pow(sine2, exponent / 2) / (2 * std::numbers::pi);
    EXPECT_NEAR(sheen.d(h) / d, 1, 5e-5) << mu;
  }
}

// By hand: the curve at a half and its mirror image, for alpha 1.
TEST(Sheen, MaskingIsTheFit) {
  const Sheen sheen = white(1);
  const auto curve = [](double x) {
    return 21.5473 / (1 + 3.82987 * std::pow(x, 0.19823)) - 1.9776 * x - 4.32054;
  };
  EXPECT_NEAR(sheen.lambda(0.3f) / std::exp(curve(0.3)), 1, 1e-5);
  EXPECT_NEAR(sheen.lambda(0.8f) / std::exp(2 * curve(0.5) - curve(0.2)), 1, 1e-5);
  EXPECT_NEAR(sheen.lambda(0.499999f), sheen.lambda(0.5f), 1e-5);
}

TEST(Sheen, IsReciprocal) {
  TestRandom random(1);
  for (int i = 0; i < 10000; ++i) {
    const Sheen sheen{{0.9f, 0.5f, 0.1f}, Sheen::kMinAlpha + (1 - Sheen::kMinAlpha) * random.next1()};
    const Vec3f a = at_cosine(0.001f + 0.999f * random.next1(), 6 * random.next1()),
                b = at_cosine(0.001f + 0.999f * random.next1(), 6 * random.next1());
    const Rgb forth = sheen.eval(a, b).f_cos * (1 / b.z), back = sheen.eval(b, a).f_cos * (1 / a.z);
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(forth[k], back[k], 1e-4f * forth[k] + 1e-30f);
    ASSERT_EQ(sheen.base_scale(a, b), sheen.base_scale(b, a));
  }
}

TEST(Sheen, SamplesWithItsDensity) {
  for (const float cosine : {1.0f, 0.5f, 0.05f}) {
    const Sheen sheen = white(0.4f);
    const Vec3f wo = at_cosine(cosine);
    TestRandom random(2);
    Statistics weights;
    const auto sample = [&]() -> std::optional<Vec3f> {
      const float u = random.next1();
      const auto s = sheen.sample(wo, u, random.next2());
      EXPECT_EQ(s->pdf, sheen.eval(wo, s->wi).pdf);
      weights.add(s->weight.y);
      return s->wi;
    };
    const auto pdf = [&](const Vec3f& wi) { return sheen.eval(wo, wi).pdf; };
    EXPECT_TRUE(samples_directions(sample, pdf, {}, 200000, 3, 1)) << cosine;
    EXPECT_TRUE(mean_is(weights, albedo(sheen, cosine), 0.03)) << cosine;
  }
}

// Off the nodes of the table.
TEST(Sheen, TableIsTheAlbedo) {
  for (const float roughness : {0.07f, 0.083f, 0.13f, 0.22f, 0.41f, 0.655f, 0.93f, 1.0f})
    for (const float mu : {1.0f, 0.83f, 0.52f, 0.31f, 0.17f, 0.08f, 0.03f, 0.004f}) {
      const Sheen sheen = white(roughness);
      const double truth = albedo(sheen, mu);
      EXPECT_NEAR(sheen_albedo(mu, sheen.alpha), truth, mu > 0.02f ? 2e-3 : 0.01)
          << roughness << " at " << mu;
    }
}

// The model's limit, in numbers: cloth of roughness .3 and more keeps within what it gets, smoother cloth
// does not near the horizon. The layer below is then black.
TEST(Sheen, ReflectsMoreThanItGetsOnlyNearTheHorizonAndWhenSmooth) {
  for (const float roughness : {0.3f, 0.5f, 0.7f, 1.0f})
    for (const float mu : {1.0f, 0.5f, 0.1f, 0.01f, 1e-3f, 1e-4f})
      EXPECT_LT(albedo(white(roughness), mu), 1) << roughness << " at " << mu;
  for (const float mu : {1.0f, 0.5f, 0.1f}) EXPECT_LT(albedo(white(0.07f), mu), 1) << mu;
  EXPECT_GT(albedo(white(0.07f), 0.01f), 2);
  EXPECT_EQ(white(0.07f).base_scale(at_cosine(0.01f), at_cosine(1)), 0);
}

// Below sheen and its scale, a white base: the furnace stays at 1 or below wherever the sheen does.
TEST(Sheen, ScalesTheBaseBelow) {
  for (const float roughness : {0.3f, 0.6f, 1.0f})
    for (const float mu : {1.0f, 0.5f, 0.1f}) {
      const Sheen sheen = white(roughness);
      const Vec3f wo = at_cosine(mu, 0);
      const auto base = [&](double z, double) {
        return 2 * z * double(sheen.base_scale(wo, at_cosine(float(z))));
      };
      const double whole = albedo(sheen, mu) + integrate(base, 0, 1, 0, 1);
      EXPECT_LT(whole, 1 + 2e-3) << roughness << " at " << mu;
      EXPECT_GT(whole, 0.5) << roughness << " at " << mu;
    }
}

TEST(Sheen, StaysFiniteAtTheHorizon) {
  TestRandom random(3);
  for (const float roughness : {0.0f, 0.3f, 1.0f})
    for (const float cosine : {1.0f, 1e-2f, 1e-4f, 1e-6f}) {
      const Sheen sheen = white(roughness);
      const Vec3f wo = at_cosine(cosine);
      for (int i = 0; i < 3000; ++i) {
        const float corners[] = {0, 0.5f, 0x1.fffffep-1f};
        const Vec2f u = i < 9 ? Vec2f(corners[i / 3], corners[i % 3]) : random.next2();
        const auto s = sheen.sample(wo, 0, u);
        ASSERT_TRUE(s && is_finite(s->weight) && s->weight.x >= 0 && s->pdf > 0 && s->wi.z > 0);
        ASSERT_NEAR(s->wi.length(), 1, 1e-5);
      }
    }
}

}  // namespace
}  // namespace parian
