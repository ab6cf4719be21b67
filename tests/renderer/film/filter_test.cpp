#include "renderer/film/filter.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr double kPiD = std::numbers::pi;
constexpr double kA[4] = {0.35875, 0.48829, 0.14128, 0.01168};
constexpr double kRadius = 1.5;
constexpr float kBelowOne = 0x1.fffffep-1f;

/// Share of the Blackman-Harris window left of x pixels: the integral of a0 + a1 cos + a2 cos 2 + a3 cos 3.
double blackman_harris_cdf(double x) {
  const double t = x / kRadius;
  double sum = kA[0] * (t + 1);
  for (int k = 1; k < 4; ++k) sum += kA[k] * std::sin(k * kPiD * t) / (k * kPiD);
  return sum / (2 * kA[0]);
}

/// Variance of an offset, in square pixels, by the closed integral of t^2 cos(k pi t).
double blackman_harris_variance() {
  double sum = kA[0] * 2 / 3;
  for (int k = 1; k < 4; ++k) sum += kA[k] * 4 * (k % 2 ? -1 : 1) / (k * k * kPiD * kPiD);
  return kRadius * kRadius * sum / (2 * kA[0]);
}

/// Counts of `samples` offsets along one axis, in bins from -radius to radius.
std::vector<double> histogram(const PixelFilter& filter, double radius, int bins, int samples,
                              std::uint32_t seed, bool vertical) {
  TestRandom random(seed);
  std::vector<double> counts(bins, 0);
  for (int i = 0; i < samples; ++i) {
    const Vec2f offset = filter.sample(random.next2());
    ++counts[std::clamp(int((double(vertical ? offset.y : offset.x) / radius + 1) * bins / 2), 0, bins - 1)];
  }
  return counts;
}

// Catches an inverse that is shifted by a step, a wrong radius, and a lost cosine term.
TEST(PixelFilter, BlackmanHarrisOffsetsFollowTheWindow) {
  const PixelFilter filter(FilterKind::blackman_harris);
  constexpr int kBins = 40, kSamples = 100000;
  std::vector<double> expected;
  for (int i = 0; i < kBins; ++i)
    expected.push_back(kSamples * (blackman_harris_cdf(kRadius * (2.0 * (i + 1) / kBins - 1)) -
                                   blackman_harris_cdf(kRadius * (2.0 * i / kBins - 1))));
  for (const bool vertical : {false, true})
    EXPECT_TRUE(chi_square(histogram(filter, kRadius, kBins, kSamples, 1, vertical), expected, 2));
}

TEST(PixelFilter, BlackmanHarrisHasTheWindowsMoments) {
  const PixelFilter filter(FilterKind::blackman_harris);
  // By the midpoint rule in u: exact but for the table.
  constexpr int kSteps = 1 << 20;
  double mean = 0, square = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double x = filter.sample({(float(i) + 0.5f) / kSteps, 0.5f}).x;
    mean += x / kSteps;
    square += x * x / kSteps;
  }
  EXPECT_NEAR(mean, 0, 1e-5);
  EXPECT_NEAR(square / blackman_harris_variance(), 1, 2e-3);
}

TEST(PixelFilter, OffsetsInvertTheCumulativeWindow) {
  const PixelFilter filter(FilterKind::blackman_harris);
  double worst = 0;
  for (int i = 0; i < 4096; ++i) {
    const double u = (i + 0.5) / 4096;
    worst = std::max(worst, std::abs(blackman_harris_cdf(filter.sample({float(u), 0.5f}).x) - u));
  }
  EXPECT_LT(worst, 1e-3);
}

TEST(PixelFilter, BoxIsUniformOverThePixel) {
  const PixelFilter filter(FilterKind::box);
  constexpr int kBins = 50, kSamples = 100000;
  for (const bool vertical : {false, true})
    EXPECT_TRUE(chi_square(histogram(filter, 0.5, kBins, kSamples, 2, vertical),
                           std::vector<double>(kBins, double(kSamples) / kBins), 2));
}

TEST(PixelFilter, StaysWithinItsRadius) {
  for (const auto& [kind, radius] : {std::pair(FilterKind::blackman_harris, 1.5f), {FilterKind::box, 0.5f}}) {
    const PixelFilter filter(kind);
    float before = -radius;
    EXPECT_EQ(filter.sample({0, 0}).x, -radius);
    for (int i = 0; i <= 4096; ++i) {
      const float x = filter.sample({std::min(float(i) / 4096, kBelowOne), 0.5f}).x;
      EXPECT_GE(x, before);
      EXPECT_LE(x, radius);
      before = x;
    }
    EXPECT_NEAR(filter.sample({0.5f, 0.5f}).x, 0, 1e-4);
  }
}

}  // namespace
}  // namespace parian
