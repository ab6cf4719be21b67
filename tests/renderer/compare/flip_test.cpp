// FLIP against numbers of the program that its authors publish, and what it must be by its definition.
#include "renderer/compare/flip.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/renderer/compare/support/flip_pictures.h"

namespace parian {
namespace {

constexpr int kWidth = 96, kHeight = 64;
constexpr double kTolerance = 2e-5;

double scaled_waves(int x, int y, int c) { return 0.8 * waves(x, y, c); }
double swapped_grain(int x, int y, int c) { return grain(x, y, 2 - c); }
double grainy_bright_waves(int x, int y, int c) { return bright_waves(x, y, c) * (0.5 + grain(x, y, c)); }
double shifted_bright_waves(int x, int y, int c) { return bright_waves(x + 2, y, c); }

RgbPlanes planes(double (*value)(int, int, int)) { return make_planes(kWidth, kHeight, value); }

void expect_map(const Plane& map, double mean_value, double at_10_7, double at_64_33, double corner) {
  EXPECT_NEAR(mean(map), mean_value, kTolerance);
  EXPECT_NEAR(map.row(7)[10], at_10_7, kTolerance);
  EXPECT_NEAR(map.row(33)[64], at_64_33, kTolerance);
  EXPECT_NEAR(map.row(0)[0], corner, kTolerance);
}

// Caught: a kernel of another width, blue-yellow with one Gaussian, the border mirrored, no Hunt adjustment.
TEST(Flip, LdrIsThatOfTheAuthors) {
  expect_map(ldr_flip(planes(scaled_waves), planes(waves)), 0.389543, 0.426453, 0.366531, 0.307412);
  expect_map(ldr_flip(planes(grain), planes(waves), 40), 0.864549, 0.882554, 0.687965, 0.725098);
  expect_map(ldr_flip(planes(swapped_grain), planes(grain)), 0.189990, 0.152649, 0.109500, 0.396347);
}

// Caught: exposures from the smallest luminance, the curve without its 0.6, the mean instead of the largest.
TEST(Flip, HdrIsThatOfTheAuthors) {
  const RgbPlanes reference = planes(bright_waves);
  const ExposureRange range = exposure_range(reference);
  EXPECT_NEAR(range.start, -4.84127, 1e-3);
  EXPECT_NEAR(range.stop, -0.20989, 1e-3);
  EXPECT_EQ(range.count, 5);
  expect_map(hdr_flip(planes(grainy_bright_waves), reference, range), 0.129825, 0.111535, 0.082578, 0.382345);
  expect_map(hdr_flip(planes(shifted_bright_waves), reference, range), 0.249936, 0.404650, 0.454033,
             0.414155);
}

TEST(Flip, OfAPictureWithItselfIsZero) {
  const RgbPlanes picture = planes(grain), bright = planes(bright_waves);
  EXPECT_EQ(std::ranges::max(ldr_flip(picture, picture).values), 0);
  EXPECT_EQ(std::ranges::max(hdr_flip(bright, bright, exposure_range(bright)).values), 0);
}

// HDR FLIP is not: its exposures are of the reference.
TEST(Flip, IsSymmetric) {
  const RgbPlanes a = planes(grain), b = planes(waves), bright = planes(bright_waves);
  EXPECT_EQ(ldr_flip(a, b).values, ldr_flip(b, a).values);
  const ExposureRange range{-2, 1, 3};
  EXPECT_EQ(hdr_flip(bright, b, range).values, hdr_flip(b, bright, range).values);
}

// 0.97 for black and white: the Hunt adjustment leaves them nearer than green and blue, whose difference
// is 1.
TEST(Flip, IsFromZeroToOne) {
  const Plane map = ldr_flip(make_planes(9, 5, [](int, int, int c) { return c == 1; }),
                             make_planes(9, 5, [](int, int, int c) { return c == 2; }));
  for (const float value : map.values) EXPECT_NEAR(value, 1, 1e-4);
  const Plane grey = ldr_flip(make_planes(9, 5, [](int, int, int) { return 0; }),
                              make_planes(9, 5, [](int, int, int) { return 1; }));
  for (const float value : grey.values) {
    EXPECT_GT(value, 0.9);
    EXPECT_LT(value, 1);
  }
}

TEST(Flip, LdrClampsAndHdrDoesNot) {
  const auto constant = [](double value) {
    return make_planes(20, 20, [=](int, int, int) { return value; });
  };
  EXPECT_EQ(mean(ldr_flip(constant(3), constant(1))), 0);
  EXPECT_EQ(mean(ldr_flip(constant(-3), constant(0))), 0);
  EXPECT_GT(mean(hdr_flip(constant(3), constant(1), exposure_range(constant(1)))), 0.01);
}

// Caught: an exposure of infinity where the median is black, NaN where the curve overflows.
TEST(Flip, TakesAnyFinitePicture) {
  const RgbPlanes black = make_planes(7, 3, [](int, int, int) { return 0; });
  EXPECT_EQ(exposure_range(black).start, 0);
  EXPECT_EQ(exposure_range(black).stop, 0);
  const RgbPlanes spot = make_planes(7, 3, [](int x, int y, int) { return x == 1 && y == 1 ? 4 : 0; });
  EXPECT_NEAR(exposure_range(spot).start, exposure_range(spot).stop, 1e-6);
  const RgbPlanes wild = make_planes(7, 3, [](int x, int, int) {
    return x == 0 ? 3e38 : x == 1 ? -3e38 : x == 2 ? 1e-40 : 1;
  });
  for (const RgbPlanes& reference : {black, spot, wild})
    for (const float value : hdr_flip(wild, reference, exposure_range(reference)).values)
      EXPECT_TRUE(value >= 0 && value <= 1) << value;
  EXPECT_GT(hdr_flip(wild, spot, exposure_range(spot)).row(0)[0], 0.5);
}

}  // namespace
}  // namespace parian
