#include "materials/lambert.h"

#include <gtest/gtest.h>

#include "tests/support/chi_square.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

const Vec3f kNormal(0, 0, 1);

// Catches a missing 1/pi, a missing cosine, and a cosine that is in twice.
TEST(Lambert, IsAlbedoOverPiTimesTheCosine) {
  const Lambert lobe{{0.2f, 0.5f, 0.8f}};
  for (const float cosine : {1.0f, 0.5f, 1e-4f}) {
    const Vec3f wi(std::sqrt(1 - cosine * cosine), 0, cosine);
    const BsdfValue value = lobe.eval(kNormal, wi);
    EXPECT_FLOAT_EQ(value.f_cos.y, 0.5f / kPi * cosine);
    EXPECT_FLOAT_EQ(value.pdf, cosine / kPi);
  }
  EXPECT_TRUE(is_black(lobe.eval(kNormal, {0, 0, -1}).f_cos));
  EXPECT_EQ(lobe.eval(kNormal, {0, 0, -1}).pdf, 0);
  EXPECT_EQ(lobe.eval(kNormal, {1, 0, 0}).pdf, 0);
}

TEST(Lambert, SamplesWithItsDensityAndWeight) {
  const Lambert lobe{{0.2f, 0.5f, 0.8f}};
  TestRandom random(1);
  const auto sample = [&]() -> std::optional<Vec3f> {
    const auto s = lobe.sample(kNormal, 0, random.next2());
    if (!s) return std::nullopt;
    const BsdfValue value = lobe.eval(kNormal, s->wi);
    EXPECT_FLOAT_EQ(s->pdf, value.pdf);
    EXPECT_NEAR(s->weight.z * s->pdf, value.f_cos.z, 1e-6);
    return s->wi;
  };
  const auto pdf = [&](const Vec3f& w) { return lobe.eval(kNormal, w).pdf; };
  EXPECT_TRUE(samples_directions(sample, pdf, {.axis = {0.6f, 0, 0.8f}}, 100000, 1, 1));
}

}  // namespace
}  // namespace parian
