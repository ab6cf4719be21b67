// What the comparison of means accepts and rejects. The chance that pictures of equal means are rejected is
// 1e-4 for each test, so that the hundreds here fail by chance once in tens of runs; the seeds are fixed.
#include "renderer/compare/block_test.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/renderer/compare/support/noisy_pictures.h"

namespace parian {
namespace {

Picture without_variance(Picture p) {
  p.channels[1] = "other";
  return p;
}

Picture with_spp(Picture p, int spp) {
  p.metadata["parian:spp"] = std::to_string(spp);
  return p;
}

int rejections(Tail tail, int side, int spp_of_test, int spp_of_reference, double level, int pairs) {
  int count = 0;
  for (int i = 0; i < pairs; ++i)
    count += !block_test(noisy_picture(tail, side, spp_of_test, std::uint32_t(2 * i), level),
                         noisy_picture(tail, side, spp_of_reference, std::uint32_t(2 * i + 1)))
                  ->means_agree();
  return count;
}

TEST(BlockTestLibrary, QuantilesAreThoseOfTheNormalDistribution) {
  EXPECT_NEAR(two_sided_normal_quantile(0.05), 1.959964, 1e-6);
  EXPECT_NEAR(two_sided_normal_quantile(1e-4 / 51), 4.7574, 1e-4);
}

TEST(BlockTestLibrary, AcceptsEqualMeans) {
  EXPECT_EQ(rejections(Tail::light, 128, 16, 16, 1, 30), 0);
  EXPECT_EQ(rejections(Tail::heavy, 128, 16, 16, 1, 30), 0);
  EXPECT_EQ(rejections(Tail::light, 128, 4, 64, 1, 30), 0);
  EXPECT_EQ(rejections(Tail::heavy, 128, 16, 1024, 1, 30), 0);
}

// Standard errors of the whole picture's mean, of both: light 1 / (128 sqrt 16) sqrt 2 = 0.28%, so 1% is 3.6
// of them at 16 spp and 14 at 256; heavy sqrt(250 / 4096) / 128 sqrt 2 = 0.27% at 4096 spp, 10.9 of them for
// 3%. Beyond 9 a test with a limit of 4.8 misses none in ten thousand.
TEST(BlockTestLibrary, RejectsABias) {
  for (const double level : {0.99, 1.01}) EXPECT_EQ(rejections(Tail::light, 128, 256, 256, level, 15), 15);
  for (const double level : {0.97, 1.03}) EXPECT_EQ(rejections(Tail::heavy, 128, 4096, 4096, level, 5), 5);
}

// A pixel of 4 samples has found the rare light with a chance of .4%; the others are too dark and believe
// themselves exact. A block of 1024 pixels has found it 4 times on average and now and then never, one of
// 4096 pixels 16 times: of 60 pairs of equal means the small blocks reject 17, the large ones 1.
TEST(BlockTestLibrary, SmallBlocksDoNotTrustTheTestsOwnVariance) {
  int by_small_blocks = 0, by_large_blocks = 0, by_test_alone = 0;
  for (std::uint32_t i = 0; i < 20; ++i) {
    const Picture test = noisy_picture(Tail::heavy, 128, 4, 2 * i),
                  reference = noisy_picture(Tail::heavy, 128, 1024, 2 * i + 1);
    const auto result = block_test(test, reference);
    EXPECT_EQ(result->blocks_per_side, 2);
    by_large_blocks += !result->means_agree();
    by_small_blocks += !block_test(test, reference, {1e-4, 1})->means_agree();
    by_test_alone += !block_test(test, without_variance(reference))->means_agree();
  }
  EXPECT_GT(by_small_blocks, 2);
  EXPECT_LE(by_large_blocks, 1);
  EXPECT_LE(by_test_alone, 1);
}

TEST(BlockTestLibrary, BlocksAreOfManyPixels) {
  const auto per_side = [](int side, bool of_test) {
    const Picture p = noisy_picture(Tail::light, side, 4, 1);
    return block_test(of_test ? p : without_variance(p), of_test ? without_variance(p) : p)->blocks_per_side;
  };
  EXPECT_EQ(per_side(256, true), 4);
  EXPECT_EQ(per_side(255, true), 3);
  EXPECT_EQ(per_side(128, true), 2);
  EXPECT_EQ(per_side(127, true), 1);
  EXPECT_EQ(per_side(128, false), 4);
  EXPECT_EQ(per_side(2, false), 2);
  EXPECT_EQ(per_side(1, false), 1);
}

// The variance of one picture stands for both by their samples. Caught: the reference's own variance for the
// difference, by which 60 of 60 pictures of fewer samples fail.
TEST(BlockTestLibrary, OneVarianceServesBothBySamples) {
  for (std::uint32_t i = 0; i < 15; ++i) {
    const Picture test = with_spp(noisy_picture(Tail::heavy, 128, 16, 2 * i), 16),
                  reference = with_spp(noisy_picture(Tail::heavy, 128, 256, 2 * i + 1), 256);
    const auto result = block_test(without_variance(test), reference);
    EXPECT_EQ(result->variance, VarianceFrom::reference);
    EXPECT_FALSE(result->other_is_exact);
    EXPECT_TRUE(result->means_agree()) << i;
    EXPECT_TRUE(block_test(test, without_variance(reference))->means_agree()) << i;
    EXPECT_TRUE(block_test(with_spp(reference, 256), without_variance(test))->means_agree()) << i;
  }
  const Picture unknown = noisy_picture(Tail::light, 128, 16, 1);
  EXPECT_TRUE(block_test(unknown, without_variance(unknown))->other_is_exact);
}

TEST(BlockTestLibrary, ScoresAreStandardErrorsOfTheirBlocks) {
  const auto make = [](float value, float variance) {
    Picture p{512, 256, {"Y", "variance.Y"}, {}, {}};
    for (int i = 0; i < 512 * 256; ++i) p.pixels.insert(p.pixels.end(), {value, variance});
    return p;
  };
  Picture test = make(1, 0.5f);
  for (int y = 64; y < 128; ++y)
    for (int x = 128; x < 256; ++x) test.at(x, y)[0] = 0.9f;
  const auto result = block_test(test, make(1, 0.5f));
  ASSERT_EQ(result->scores.size(), 17u);
  const BlockScore& worst = result->worst();
  EXPECT_EQ(worst.x0, 128);
  EXPECT_EQ(worst.y0, 64);
  EXPECT_EQ(worst.x1, 256);
  EXPECT_EQ(worst.y1, 128);
  EXPECT_NEAR(worst.z, -0.1 * std::sqrt(128 * 64), 1e-2);
  EXPECT_NEAR(result->scores[0].z, -0.1 * 128 * 64 / std::sqrt(512 * 256), 1e-2);
  EXPECT_FALSE(result->means_agree());
  EXPECT_TRUE(block_test(test, make(1, 0.5f), {1e-30, 1})->means_agree());
}

TEST(BlockTestLibrary, WhatIsNotFiniteFails) {
  const Picture good = noisy_picture(Tail::light, 64, 16, 1);
  EXPECT_TRUE(block_test(good, good)->means_agree());
  EXPECT_FALSE(block_test(without_variance(good), without_variance(good)).has_value());
  for (const float value : {NAN, INFINITY, -INFINITY})
    for (const int channel : {0, 1}) {
      Picture bad = good;
      bad.at(5, 6)[channel] = value;
      EXPECT_FALSE(block_test(bad, good)->means_agree()) << value << channel;
      EXPECT_FALSE(block_test(good, bad)->means_agree()) << value << channel;
      EXPECT_FALSE(block_test(bad, bad)->means_agree()) << value << channel;
    }
}

TEST(BlockTestLibrary, AVarianceIsNotNegative) {
  Picture bad = noisy_picture(Tail::light, 64, 16, 1);
  bad.at(5, 6)[1] = -1e-3f;
  EXPECT_FALSE(block_test(bad, bad)->means_agree());
}

// Equal but for rounding, or not equal.
TEST(BlockTestLibrary, PicturesWithoutNoise) {
  Picture p = noisy_picture(Tail::light, 64, 16, 1);
  for (std::size_t i = 1; i < p.pixels.size(); i += 2) p.pixels[i] = 0;
  EXPECT_TRUE(block_test(p, p)->means_agree());
  Picture brighter = p;
  for (std::size_t i = 0; i < p.pixels.size(); i += 2) brighter.pixels[i] *= 1.0001f;
  EXPECT_FALSE(block_test(brighter, p)->means_agree());
}

}  // namespace
}  // namespace parian
