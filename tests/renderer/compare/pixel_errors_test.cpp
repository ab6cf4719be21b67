#include "renderer/compare/pixel_errors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace parian {
namespace {

Picture constant(float value, int width = 100, int height = 100) {
  return {width, height, {"R", "G"}, std::vector<float>(std::size_t(2 * width * height), value), {}};
}

TEST(PixelErrors, RelativeMseIsThatOfTheFormula) {
  EXPECT_EQ(relative_mse(constant(2), constant(2)), 0);
  EXPECT_NEAR(relative_mse(constant(1.5f), constant(1)), 0.25 / 1.01, 1e-9);
  EXPECT_NEAR(relative_mse(constant(0.5f), constant(0)), 25, 1e-9);
  Picture half = constant(1);
  for (std::size_t i = 0; i < half.pixels.size(); i += 2) half.pixels[i] = 2;
  EXPECT_NEAR(relative_mse(half, constant(1)), 0.5 / 1.01, 1e-9);
}

TEST(PixelErrors, PsnrIsInDecibels) {
  EXPECT_NEAR(peak_signal_to_noise(0.01, 1), 20, 1e-12);
  EXPECT_NEAR(peak_signal_to_noise(0.01, 10), 40, 1e-12);
  EXPECT_EQ(peak_signal_to_noise(0, 1), INFINITY);
}

// What a mean of ten thousand pixels moves by 1e-4 for.
TEST(PixelErrors, OneBlackPixelIsTheLargestDifference) {
  Picture p = constant(1);
  p.at(71, 13)[1] = 0;
  const LargestDifference largest = largest_difference(p, constant(1));
  EXPECT_EQ(largest.difference, 1);
  EXPECT_EQ(largest.x, 71);
  EXPECT_EQ(largest.y, 13);
  EXPECT_EQ(largest.channel, "G");
}

// Caught: a NaN lost in a comparison, two that cancel, one on which a mean is taken.
TEST(PixelErrors, WhatIsNotFiniteIsNotLost) {
  const Picture good = constant(1, 4, 4);
  for (const float value : {NAN, INFINITY, -INFINITY}) {
    Picture bad = good;
    bad.at(2, 1)[0] = value;
    bad.at(2, 1)[1] = value;
    bad.at(3, 3)[0] = 1e30f;
    const std::vector<bool> found = not_finite_pixels(bad);
    EXPECT_EQ(std::ranges::count(found, true), 1);
    EXPECT_TRUE(found[6]);
    using Pair = std::pair<const Picture*, const Picture*>;
    for (const auto& [t, r] : {Pair(&bad, &good), Pair(&good, &bad), Pair(&bad, &bad)}) {
      EXPECT_TRUE(std::isnan(relative_mse(*t, *r)));
      const LargestDifference largest = largest_difference(*t, *r);
      EXPECT_FALSE(std::isfinite(largest.difference));
      EXPECT_EQ(largest.x, 2);
      EXPECT_EQ(largest.y, 1);
    }
  }
}

TEST(PixelErrors, RelativeErrorsAreOfTheirPixels) {
  Picture p = constant(1, 3, 2);
  p.at(1, 1)[0] = 2;
  const Plane errors = relative_errors(p, constant(1, 3, 2));
  EXPECT_NEAR(errors.row(1)[1], std::sqrt(0.5 / 1.01), 1e-6);
  EXPECT_EQ(errors.row(0)[1], 0);
}

}  // namespace
}  // namespace parian
