#include "materials/diffuse_transmission.h"

#include <gtest/gtest.h>

#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

const DiffuseTransmissionLobe kLeaf{{0.1f, 0.4f, 0.2f}, {0.3f, 0.5f, 0.1f}};

// Catches a missing 1/pi, a negative cosine, and the two sides exchanged.
TEST(DiffuseTransmission, IsTheColourOfTheSideOverPiTimesTheCosine) {
  for (const float cosine : {1.0f, 0.5f, 1e-4f}) {
    const Vec3f wo = at_cosine(0.3f), above = at_cosine(cosine), below = at_cosine(-cosine);
    EXPECT_FLOAT_EQ(kLeaf.eval(wo, above).f_cos.y, 0.4f / kPi * cosine);
    EXPECT_FLOAT_EQ(kLeaf.eval(wo, below).f_cos.y, 0.5f / kPi * cosine);
  }
}

TEST(DiffuseTransmission, SamplesWithItsDensityOnBothSides) {
  for (const auto& lobe : {kLeaf, DiffuseTransmissionLobe{{0.5f, 0.5f, 0.5f}, {0, 0, 0}},
                           DiffuseTransmissionLobe{{0, 0, 0}, {0.5f, 0.5f, 0.5f}}})
    for (const float cosine : {1.0f, 0.1f}) {
      TestRandom random(1);
      const Vec3f wo = at_cosine(cosine);
      const auto sample = [&]() -> std::optional<Vec3f> {
        const float u = random.next1();
        const auto s = lobe.sample(wo, u, random.next2());
        return s ? std::optional(s->wi) : std::nullopt;
      };
      const auto pdf = [&](const Vec3f& wi) { return lobe.eval(wo, wi).pdf; };
      EXPECT_TRUE(samples_directions(sample, pdf, {}, 200000, 6, 1)) << lobe.reflected << lobe.transmitted;
    }
}

// Furnace: all that comes goes on, half here and half there.
TEST(DiffuseTransmission, ReflectsAndTransmitsWhatItsColoursSay) {
  const Vec3f wo = at_cosine(0.2f);
  const auto f = [&](const Vec3f& wi) { return double(kLeaf.eval(wo, wi).f_cos.y); };
  EXPECT_NEAR(SphereCells{}.integral([&](const Vec3f& wi) { return wi.z > 0 ? f(wi) : 0; }), 0.4, 1e-4);
  EXPECT_NEAR(SphereCells{}.integral([&](const Vec3f& wi) { return wi.z < 0 ? f(wi) : 0; }), 0.5, 1e-4);

  TestRandom random(2);
  Statistics reflected, transmitted, white;
  for (int i = 0; i < 200000; ++i) {
    const float u = random.next1();
    const Vec2f u2 = random.next2();
    const auto s = kLeaf.sample(wo, u, u2);
    reflected.add(s && s->wi.z > 0 ? s->weight.x : 0);
    transmitted.add(s && s->wi.z < 0 ? s->weight.x : 0);
    const auto w = DiffuseTransmissionLobe{{0.25f, 0.25f, 0.25f}, {0.75f, 0.75f, 0.75f}}.sample(wo, u, u2);
    white.add(w ? w->weight.x : 0);
  }
  EXPECT_TRUE(mean_is(reflected, 0.1, 0.02));
  EXPECT_TRUE(mean_is(transmitted, 0.3, 0.02));
  EXPECT_TRUE(mean_is(white, 1, 1e-4));
}

TEST(DiffuseTransmission, WeightIsTheValueOverTheDensity) {
  TestRandom random(3);
  const float corners[] = {0, 0.5f, 0x1.fffffep-1f};
  const DiffuseTransmissionLobe lobes[] = {
      kLeaf, {{0, 0, 0}, {0, 0, 0}}, {{1e-6f, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {0, 0, 1e-6f}}};
  for (int i = 0; i < 40000; ++i) {
    const DiffuseTransmissionLobe& lobe = lobes[i % 4];
    const Vec3f wo = at_cosine(i % 3 ? 1 - random.next1() : 1e-4f);
    const float u = random.next1();
    const Vec2f u2 = i < 36 ? Vec2f(corners[i / 4 % 3], corners[i / 12]) : random.next2();
    const auto s = lobe.sample(wo, u, u2);
    if (!s) continue;
    const BsdfValue value = lobe.eval(wo, s->wi);
    ASSERT_GT(s->pdf, 0);
    ASSERT_EQ(s->pdf, value.pdf);
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(s->weight[k], value.f_cos[k] / value.pdf, 1e-5f * (1 + s->weight[k]));
    ASSERT_NEAR(s->wi.length(), 1, 1e-5);
  }
}

}  // namespace
}  // namespace parian
