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

// GT 21. Catches a missing Jacobian, eta for 1 / eta, and a masking of one side only.
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

// Chi-square over the whole sphere, and the density's integral, over roughness and grazing angles, from both
// sides of the interface.
TEST(Dielectric, SamplesWithItsDensity) {
  for (const float eta : {1.5f, 1 / 1.5f})
    for (const bool thin : {false, true})
      for (const float alpha : {0.2f, 0.5f, 1.0f})
        for (const float cosine : {1.0f, 0.5f, 0.1f}) {
          const Dielectric lobe = make(eta, alpha, thin);
          const Vec3f wo = at_cosine(cosine);
          TestRandom random(std::uint32_t(alpha * 100 + cosine * 10));
          const auto sample = [&]() -> std::optional<Vec3f> {
            const float u = random.next1();
            const auto s = lobe.sample(wo, u, random.next2());
            if (!s) return std::nullopt;
            const BsdfValue value = lobe.eval(wo, s->wi);
            EXPECT_NEAR(value.pdf / s->pdf, 1, 1e-3);
            EXPECT_NEAR(value.f_cos.x / s->pdf, s->weight.x, 1e-3 * s->weight.x + 1e-6);
            return s->wi;
          };
          const auto density = [&](const Vec3f& wi) { return lobe.eval(wo, wi).pdf; };
          const SphereCells cells{.rings = 24, .sectors = 16, .tolerance = 1e-6, .depth = 7};
          EXPECT_TRUE(samples_directions(sample, density, cells, 60000, 36))
              << eta << thin << " " << alpha << " at " << cosine;
        }
}

// Narrow lobes, in cells around the refracted direction; what is reflected fails here.
TEST(Dielectric, SamplesNarrowTransmissionWithItsDensity) {
  for (const float eta : {1.5f, 1 / 1.5f})
    for (const float alpha : {1e-3f, 1e-2f, 0.05f})
      for (const float cosine : {1.0f, 0.8f}) {
        const Dielectric lobe = make(eta, alpha);
        const Vec3f wo = at_cosine(cosine);
        TestRandom random(std::uint32_t(alpha * 1e4 + cosine * 10));
        const auto sample = [&]() -> std::optional<Vec3f> {
          const float u = random.next1();
          const auto s = lobe.sample(wo, u, random.next2());
          if (!s || s->wi.z > 0) return std::nullopt;
          return s->wi;
        };
        const auto density = [&](const Vec3f& wi) { return wi.z < 0 ? lobe.eval(wo, wi).pdf : 0; };
        const SphereCells cells{.axis = *refract(wo, {0, 0, 1}, eta),
                                .zoom = 0.05 * alpha * alpha,
                                .rings = 24,
                                .sectors = 12,
                                .tolerance = 1e-6,
                                .depth = 6};
        EXPECT_TRUE(samples_directions(sample, density, cells, 60000, 12))
            << eta << " " << alpha << " at " << cosine;
      }
}

// f / n^2 on wi's side is the same in both directions: what goes through the interface one way goes the
// other.
TEST(Dielectric, TransmissionIsReciprocal) {
  const Dielectric out = make(1.5f, 0.4f), in = make(1 / 1.5f, 0.4f);
  TestRandom random(9);
  int compared = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3f wo = at_cosine(0.05f + 0.9f * random.next1(), 6 * random.next1());
    const auto s = out.sample(wo, 0.9f, random.next2());
    if (!s || s->wi.z > 0) continue;
    // Seen from below, z turned over; eval() has the cosine in.
    const Vec3f from(s->wi.x, s->wi.y, -s->wi.z), to(wo.x, wo.y, -wo.z);
    const float forth = out.eval(wo, s->wi).f_cos.x / -s->wi.z, back = in.eval(from, to).f_cos.x / wo.z;
    // Basic radiance: the bare f of either has the square of the index of its own far side in it.
    EXPECT_NEAR(forth / (1.5f * 1.5f) / back, 1, 2e-3);
    ++compared;
  }
  EXPECT_GT(compared, 300);
}

// GT 49.
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
