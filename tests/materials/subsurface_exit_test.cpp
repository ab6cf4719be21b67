#include "materials/subsurface_exit.h"

#include <gtest/gtest.h>

#include "materials/bsdf.h"
#include "tests/support/chi_square.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

const Rgb kTint(0.2f, 0.5f, 0.9f);

SubsurfaceExit make_exit(float eta) { return {eta, SubsurfaceExit::make_inverse_c(eta), kTint}; }

// Catches a c that is of the other side (F from inside: 1.27 at 1.3), a lost pi or a cosine too many.
TEST(SubsurfaceExit, LetsAllOut) {
  const Vec3f wo(0.6f, 0, 0.8f);
  for (const float eta : {1.0f, 1.3f, 1.5f, 2.0f}) {
    const SubsurfaceExit lobe = make_exit(eta);
    const SphereCells cells{.depth = 5};
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(cells.integral([&](const Vec3f& w) { return lobe.eval(wo, w).f_cos[k]; }), kTint[k], 1e-4)
          << eta;
  }
}

TEST(SubsurfaceExit, IsLambertWithoutAnInterface) {
  const BsdfValue value = make_exit(1).eval({0, 0, 1}, {0.6f, 0, 0.8f});
  EXPECT_NEAR(value.f_cos.y, 0.5 * 0.8 / kPi, 1e-6);
  EXPECT_NEAR(value.pdf, 0.8 / kPi, 1e-6);
}

// 1 - F of index 1.5 at normal incidence and at 75 degrees, over c = .908222.
TEST(SubsurfaceExit, FallsAsFresnelLetsThrough) {
  const SubsurfaceExit lobe = make_exit(1.5f);
  const float cosine = std::cos(75 * kPi / 180);
  EXPECT_NEAR(lobe.eval({0, 0, 1}, {0, 0, 1}).f_cos.z, 0.9 * 0.96 / 0.908222 / kPi, 1e-6);
  EXPECT_NEAR(lobe.eval({0, 0, 1}, {std::sqrt(1 - cosine * cosine), 0, cosine}).f_cos.z,
              0.9 * (1 - 0.253061) * cosine / 0.908222 / kPi, 1e-6);
}

TEST(SubsurfaceExit, DependsOnTheWayOutAlone) {
  const SubsurfaceExit lobe = make_exit(1.3f);
  const Vec3f wi(0.48f, 0.64f, 0.6f);
  EXPECT_EQ(lobe.eval({0, 0, 1}, wi).f_cos, lobe.eval({0.8f, 0, 0.6f}, wi).f_cos);
  for (const Vec3f& outside : {Vec3f(0, 0, -1), Vec3f(1, 0, 0)}) {
    EXPECT_TRUE(is_black(lobe.eval({0, 0, 1}, outside).f_cos));
    EXPECT_EQ(lobe.eval({0, 0, 1}, outside).pdf, 0);
  }
}

TEST(SubsurfaceExit, SamplesWithItsDensityAndWeight) {
  const SubsurfaceExit lobe = make_exit(1.4f);
  const Vec3f wo(0, 0, 1);
  TestRandom random(1);
  const auto sample = [&]() -> std::optional<Vec3f> {
    const auto s = lobe.sample(wo, 0, random.next2());
    if (!s) return std::nullopt;
    const BsdfValue value = lobe.eval(wo, s->wi);
    EXPECT_FLOAT_EQ(s->pdf, value.pdf);
    EXPECT_NEAR(s->weight.z * s->pdf, value.f_cos.z, 1e-6);
    return s->wi;
  };
  const auto pdf = [&](const Vec3f& w) { return lobe.eval(wo, w).pdf; };
  EXPECT_TRUE(samples_directions(sample, pdf, {.axis = {0.6f, 0, 0.8f}}, 100000, 1, 1));
}

TEST(SubsurfaceExit, AsABsdfTransmitsNothing) {
  Surface s{};
  s.ng = s.smooth_normal = s.wo = {0, 0, 1};
  s.front = true;
  s.frame = make_frame({0, 0, 1});
  const Bsdf bsdf(s, make_exit(1.3f));
  EXPECT_FALSE(bsdf.transmits());
  EXPECT_GT(bsdf.eval({0, 0.6f, 0.8f}).pdf, 0);
  EXPECT_EQ(bsdf.eval({0, 0.6f, -0.8f}).pdf, 0);
}

}  // namespace
}  // namespace parian
