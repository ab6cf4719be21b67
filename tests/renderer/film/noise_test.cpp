// The noise of a picture: closed forms, and whether the bound keeps its word.
#include "renderer/film/noise.h"

#include <gtest/gtest.h>

#include "renderer/film/film.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

void add(FilmTile& tile, int x, int y, const Rgb& c) {
  tile.pixels[std::size_t(y - tile.area.y0) * (tile.area.x1 - tile.area.x0) + (x - tile.area.x0)].add(c);
}

// One block of four pixels with means of 2.5 and halves that are 1.5 and 3.5, and one of a single pixel
// without noise. Caught: the variance of a half for that of the whole, pixels of the edge that count as whole
// blocks, a floor that is missing, squared once too often, or not of the whole picture.
TEST(Noise, IsTheRootMeanSquareErrorOverTheMeanOfTheBlock) {
  Film film(5, 1, {});
  FilmTile tile = film.checkout({0, 0, 5, 1});
  for (int x = 0; x < 4; ++x)
    for (const float c : {1, 2, 3, 4}) add(tile, x, 0, {c, c, c});
  for (int i = 0; i < 4; ++i) add(tile, 4, 0, {5, 5, 5});
  tile.rays = {160, 12};
  film.merge(tile);
  const BlockNoise noise = film.block_noise();
  ASSERT_EQ(noise.columns, 2);
  ASSERT_EQ(noise.rows, 1);
  EXPECT_EQ(noise.samples, (std::vector<std::uint32_t>{4, 4}));
  EXPECT_EQ(noise.cost, (std::vector<double>{10, 3}));
  const double floor = kNoiseFloor * 3, variance = 1, error = variance / (2.5 * 2.5 + floor * floor);
  EXPECT_NEAR(noise.error[0], error, 1e-12);
  const double least = 2.5 - 1.645 * std::sqrt(variance / 4);
  EXPECT_NEAR(noise.most_error[0], variance / (least * least + floor * floor), 1e-12);
  EXPECT_EQ(noise.error[1], 0);
  EXPECT_NEAR(film.noise().estimate, std::sqrt(0.8 * error), 1e-12);
  EXPECT_GT(film.noise().bound, std::sqrt(0.8 * noise.most_error[0]));
}

// Of any number of independent samples. Caught: halves weighed alike where one has two thirds, or the wrong
// half kept.
TEST(Noise, HalvesPredictTheVarianceOfTheMean) {
  for (const int samples : {2, 3, 6, 7, 8, 17}) {
    Statistics predicted;
    TestRandom random(std::uint32_t(40 + samples));
    for (int i = 0; i < 400; ++i) {
      Film film(4, 4, {});
      FilmTile tile = film.checkout({0, 0, 4, 4});
      tile.rays = {16};
      for (int p = 0; p < 16; ++p)
        for (int k = 0; k < samples; ++k) {
          const float c = 10 + random.next1();
          add(tile, p % 4, p / 4, {c, c, c});
        }
      film.merge(tile);
      predicted.add(film.block_noise().error[0]);
    }
    const double floor = kNoiseFloor * 10.5;
    EXPECT_TRUE(mean_is(predicted, 1.0 / 12 / samples / (10.5 * 10.5 + floor * floor), 0.1)) << samples;
  }
}

TEST(Noise, OfOneSampleIsUnknownAndOfBlackNone) {
  Film film(4, 4, {});
  EXPECT_EQ(film.noise().bound, INFINITY);
  for (int sample = 1; sample <= 2; ++sample) {
    FilmTile tile = film.checkout({0, 0, 4, 4});
    for (int i = 0; i < 16; ++i) add(tile, i % 4, i / 4, {0, 0, 0});
    film.merge(tile);
    EXPECT_EQ(film.noise().bound, sample == 1 ? INFINITY : 0.0);
  }
}

/// A film of 32 x 32 pixels with means of 1 to 5 and independent samples: exponential, or, where `rare` is
/// the share of samples that have half of the energy, mixed with these.
struct Simulated {
  static constexpr int kSize = 32;
  Film film{kSize, kSize, {}};

  static double mean(int x) { return 1 + x / 8; }
  Simulated(int samples, double rare, std::uint32_t seed) {
    TestRandom random(seed);
    FilmTile tile = film.checkout({0, 0, kSize, kSize});
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int i = 0; i < samples; ++i) {
          double value = -std::log(1 - random.next1());
          if (rare > 0) value = (value + (random.next1() < rare ? 1 / rare : 0)) / 2;
          add(tile, x, y, Rgb(float(mean(x) * value)));
        }
    film.merge(tile);
  }
  /// As Noise defines it, with what is known here.
  double true_error() const {
    const Picture picture = film.resolve();
    double picture_mean = 0, error = 0;
    for (int x = 0; x < kSize; ++x) picture_mean += mean(x) / kSize;
    const double floor = kNoiseFloor * picture_mean;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        error += std::pow(picture.at(x, y)[0] - mean(x), 2) / (mean(x) * mean(x) + floor * floor);
    return std::sqrt(error / (kSize * kSize));
  }
};

/// Of `count` films, those whose true error is within the bound.
int covered(int count, int samples, double rare) {
  int within = 0;
  for (int i = 0; i < count; ++i) {
    const Simulated s(samples, rare, std::uint32_t(7 + i));
    within += s.true_error() <= s.film.noise().bound;
  }
  return within;
}

// 95% of pictures at least are within the bound: of 200, all but 10; with 17 more a true coverage of 95%
// passes by all but one in ten thousand. Caught: the estimate in place of the bound (half of the pictures),
// and, where a sample in a thousand has half of the energy, blocks measured by means that the error itself
// made large (none).
TEST(Noise, BoundHoldsWithTheConfidenceItStates) {
  EXPECT_GE(covered(200, 16, 0), 179);
  EXPECT_GE(covered(200, 64, 0), 179);
  EXPECT_GE(covered(200, 32, 1e-3), 179);
  EXPECT_GE(covered(60, 256, 1e-3), 51);
}

// And says something: with even noise it is close to what is true.
TEST(Noise, BoundIsCloseWhereNoiseIsEven) {
  for (const int samples : {16, 64, 256}) {
    Statistics estimate, bound;
    for (int i = 0; i < 20; ++i) {
      const Simulated s(samples, 0, std::uint32_t(1000 + i));
      estimate.add(s.film.noise().estimate / s.true_error());
      bound.add(s.film.noise().bound / s.true_error());
    }
    EXPECT_NEAR(estimate.mean(), 1, 0.03) << samples;
    EXPECT_LT(bound.mean(), samples == 16 ? 1.25 : 1.15) << samples;
  }
}

}  // namespace
}  // namespace parian
