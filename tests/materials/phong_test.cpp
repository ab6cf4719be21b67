#include "materials/phong.h"

#include <gtest/gtest.h>

#include "tests/materials/support/lobes.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

Phong glossy(float exponent) { return {{0, 0, 0}, {1, 1, 1}, exponent}; }
Phong mixed(float exponent) { return {{0.4f, 0.2f, 0.1f}, {0.3f, 0.5f, 0.6f}, exponent}; }

/// Cells around the mirror direction that resolve the lobe there.
SphereCells lobe_cells(const Phong& lobe, const Vec3f& wo) {
  return {.axis = {-wo.x, -wo.y, wo.z},
          .zoom = 0.2 / (1 + lobe.exponent),
          .rings = 20,
          .sectors = 10,
          .tolerance = 2e-6,
          .depth = 5};
}

/// Albedo from wo, by quadrature of eval().
double albedo(const Phong& lobe, float cosine) {
  const Vec3f wo = at_cosine(cosine);
  return lobe_cells(lobe, wo).integral([&](const Vec3f& wi) { return lobe.eval(wo, wi).f_cos.y; });
}

// 1 at normal incidence, less at an angle. Catches (n + 1) for (n + 2), and a specular lobe that lacks
// the cosine.
TEST(Phong, HasTheAlbedoOfItsNormalisation) {
  const struct {
    float exponent, cosine;
    double truth, tolerance;
  } cases[] = {{0, 1, 1, 1e-4},
               {0, 0.5f, 0.75, 5e-4},  // (1 + cos) / 2
               {1, 1, 1, 1e-4},
               {1, 0.5f, 0.609, 6e-4},
               {10, 1, 1, 1e-4},
               {10, 0.5f, 0.5047, 1e-4},
               {50, 1, 1, 1e-4},
               {50, 0.5f, 0.5, 1e-4},
               {1e4f, 1, 1, 1e-3},
               {1e6f, 1, 1, 1e-3},
               // Far from the horizon the mean of cos wi is cos (n + 1) / (n + 2).
               {1e4f, 0.3f, 0.3, 1e-3},
               {1e6f, 0.3f, 0.3, 1e-3}};
  for (const auto& c : cases) {
    EXPECT_NEAR(albedo(glossy(c.exponent), c.cosine), c.truth, c.tolerance) << c.exponent << " " << c.cosine;
    EXPECT_TRUE(mean_is(sampled_albedo(glossy(c.exponent), c.cosine, 200000), c.truth, 0.01))
        << c.exponent << " " << c.cosine;
  }
}

TEST(Phong, DiffuseAndSpecularAdd) {
  for (const float exponent : {0.0f, 10.0f, 1000.0f})
    for (const float cosine : {1.0f, 0.5f, 0.1f}) {
      const double truth = 0.2 + 0.5 * albedo(glossy(exponent), cosine);
      EXPECT_NEAR(albedo(mixed(exponent), cosine), truth, 1e-4);
      EXPECT_TRUE(mean_is(sampled_albedo(mixed(exponent), cosine, 100000), truth, 0.02));
    }
}

TEST(Phong, HasTheRightValue) {
  const Vec3f n(0, 0, 1);
  const BsdfValue value = mixed(7).eval(n, at_cosine(0.5f));
  EXPECT_NEAR(value.f_cos.x, 0.5 * (0.4 / kPiD + 0.3 * 9 / (2 * kPiD) * std::pow(0.5, 7)), 1e-6);
  // Only diffuse: more than 90 degrees from the mirror direction. Black: below.
  const Vec3f wo = at_cosine(0.2f, 0), wi = at_cosine(0.2f, 0);
  EXPECT_NEAR(mixed(7).eval(wo, wi).f_cos.x, 0.2 * 0.4 / kPiD, 1e-6);
  EXPECT_NEAR(mixed(0).eval(wo, wi).f_cos.x, 0.2 * 0.4 / kPiD, 1e-6);
  EXPECT_TRUE(is_black(mixed(7).eval(wo, -wi).f_cos));
  EXPECT_EQ(mixed(7).eval(wo, -wi).pdf, 0);
  // 1e6 at one lobe's width from the mirror direction: cos^n = exp(-n / 2 angle^2).
  const float angle = 1.5e-3f;
  const Vec3f near(std::sin(angle), 0, std::cos(angle));
  EXPECT_NEAR(
      glossy(1e6f).eval(n, near).f_cos.x / ((1e6 + 2) / (2 * kPiD) * std::exp(-0.5e6 * angle * angle)), 1,
      1e-4);
}

// Catches a density that is not the sampler's, and a choice that is not the probability in the pdf.
TEST(Phong, SamplesWithItsDensity) {
  for (const float exponent : {0.0f, 1.0f, 10.0f, 100.0f, 1e4f})
    for (const float cosine : {1.0f, 0.6f, 0.1f, 0.01f})
      for (const auto& lobe : {glossy(exponent), mixed(exponent), Phong{{1, 1, 1}, {0, 0, 0}, exponent}}) {
        const Vec3f wo = at_cosine(cosine);
        TestRandom random(std::uint32_t(exponent + cosine * 100));
        const auto sample = [&]() -> std::optional<Vec3f> {
          const float u = random.next1();
          const auto s = lobe.sample(wo, u, random.next2());
          return s ? std::optional(s->wi) : std::nullopt;
        };
        const auto pdf = [&](const Vec3f& wi) { return lobe.eval(wo, wi).pdf; };
        EXPECT_TRUE(samples_directions(sample, pdf, lobe_cells(lobe, wo), 50000, 60))
            << "exponent " << exponent << ", cosine " << cosine << ", specular " << lobe.specular.x;
      }
}

TEST(Phong, WeightIsTheValueOverTheDensity) {
  TestRandom random(2);
  for (int i = 0; i < 20000; ++i) {
    const float diffuse = random.next1();
    const Phong lobe{
        {diffuse, random.next1(), 0}, {0.1f, random.next1(), 1}, std::pow(10.0f, 6 * random.next1())};
    const Vec3f wo = at_cosine(1 - random.next1());
    const float u = random.next1();
    const auto s = lobe.sample(wo, u, random.next2());
    if (!s) continue;
    const BsdfValue value = lobe.eval(wo, s->wi);
    ASSERT_GT(s->pdf, 0);
    ASSERT_EQ(s->pdf, value.pdf);
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(s->weight[k], value.f_cos[k] / value.pdf, 1e-5f * (1 + s->weight[k]));
    ASSERT_GT(s->wi.z, 0);
    ASSERT_NEAR(s->wi.length(), 1, 1e-5);
  }
}

TEST(Phong, NeverReflectsMoreThanItGets) {
  for (const float exponent : {0.0f, 0.5f, 3.0f, 30.0f, 3000.0f})
    for (const float cosine : {1.0f, 0.7f, 0.3f, 0.1f, 0.01f})
      EXPECT_LT(albedo(glossy(exponent), cosine), 1 + 1e-4) << exponent << " at " << cosine;
}

// From flat sight to large exponents, with the corners of the square, nothing but finite numbers.
TEST(Phong, StaysFiniteForLargeExponentsAndGrazingAngles) {
  TestRandom random(4);
  for (const float exponent : {0.0f, 1.0f, 100.0f, 1e4f, 1e6f, 1e8f})
    for (const float cosine : {1.0f, 0.1f, 1e-2f, 1e-3f, 1e-4f, 1e-6f})
      for (const auto& lobe : {glossy(exponent), mixed(exponent), Phong{{0, 0, 0}, {0, 0, 0}, exponent}}) {
        const Vec3f wo = at_cosine(cosine);
        for (int i = 0; i < 1000; ++i) {
          const float corners[] = {0, 0.5f, kBelowOne};
          const Vec2f u = i < 9 ? Vec2f(corners[i / 3], corners[i % 3]) : random.next2();
          const auto s = lobe.sample(wo, i % 2 ? 0 : kBelowOne, u);
          const BsdfValue value = lobe.eval(wo, random.next1() < 0.5f ? wo : at_cosine(random.next1(), 4));
          ASSERT_TRUE(is_finite(value.f_cos) && value.f_cos.x >= 0 && std::isfinite(value.pdf) &&
                      value.pdf >= 0);
          if (!s) continue;
          ASSERT_TRUE(is_finite(s->wi) && is_finite(s->weight) && s->weight.x >= 0 && std::isfinite(s->pdf) &&
                      s->pdf > 0)
              << exponent << " at " << cosine;
          ASSERT_LE(s->weight.y, 8) << exponent << " at " << cosine;
        }
      }
}

}  // namespace
}  // namespace parian
