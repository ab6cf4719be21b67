/// Directions and albedos for tests of lobes.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "materials/lobe.h"
#include "tests/support/statistics.h"

namespace parian {

inline constexpr double kPiD = std::numbers::pi;
inline constexpr float kBelowOne = 0x1.fffffep-1f;

/// A unit direction in the shading frame.
inline Vec3f at_cosine(float cosine, float phi = 0.7f) {
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

/// The albedo from wo in the second channel, by the weights of sample().
template <Lobe T>
Statistics sampled_albedo(const T& lobe, float cosine, int samples, std::uint32_t seed = 1) {
  const Vec3f wo = at_cosine(cosine);
  TestRandom random(seed);
  Statistics s;
  for (int i = 0; i < samples; ++i) {
    const float u = random.next1();
    const auto sample = lobe.sample(wo, u, random.next2());
    s.add(sample ? sample->weight.y : 0);
  }
  return s;
}

/// Albedos of GGX facets that reflect all, with height-correlated masking. The separable form gives
/// .68601 at alpha .5, mu .5, and .40914 at alpha 1.
struct GgxTruth {
  float alpha, cosine;
  double albedo;
};
inline const GgxTruth kGgxTruths[] = {{0.5f, 1, 0.68785},
                                      {0.5f, 0.5f, 0.69825},
                                      {1, 1, 1 - std::log(2.0)},
                                      {1, 0.5f, 0.45069},
                                      {0.1f, 1, 0.98830}};

/// Facet normals as seen from wo, of a distribution isotropic or not: unit, facing wo, above the surface, and
/// of finite density, at the corners of the square of random numbers too.
template <class Facets>
void expect_finite_facets(const Facets& facets, float cosine) {
  const Vec3f wo = at_cosine(cosine);
  TestRandom random(3);
  for (int i = 0; i < 2000; ++i) {
    const float corners[] = {0, 0.5f, kBelowOne};
    const Vec2f u = i < 9 ? Vec2f(corners[i / 3], corners[i % 3]) : random.next2();
    const Vec3f h = facets.sample_visible_normal(wo, u);
    ASSERT_NEAR(h.length(), 1, 1e-5);
    ASSERT_GE(h.z, 0);
    ASSERT_GE(wo.dot(h), -1e-6f);
    ASSERT_TRUE(std::isfinite(facets.d(h)) && std::isfinite(facets.pdf_visible_normal(wo, h)));
  }
  ASSERT_TRUE(facets.g2(wo, wo) >= 0 && facets.g2(wo, wo) <= 1);
}

}  // namespace parian
