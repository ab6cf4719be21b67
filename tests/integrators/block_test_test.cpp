// What the comparison of pictures sees, and what a comparison pixel by pixel does not.
#include "tests/support/block_test.h"

#include <random>

namespace parian {
namespace {

/// Pixels of mean 1, or a gradient, from 64 exponential samples each, `factor` times as bright.
Picture noisy_picture(std::uint32_t seed, float factor) {
  std::mt19937 engine(seed);
  // The sum of 64 exponential numbers, and that of their squares from its expectation: enough for a variance.
  std::gamma_distribution<float> sum(64, 1.0f / 64);
  Picture p{128, 128, {"R", "G", "B", "variance.R", "variance.G", "variance.B"}, {}, {}};
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const float level = factor * (0.5f + float(x + y) / 256);
      float values[3];
      for (float& v : values) v = level * sum(engine);
      p.pixels.insert(p.pixels.end(), values, values + 3);
      for (int k = 0; k < 3; ++k) p.pixels.push_back(level * level / 64);
    }
  return p;
}

/// The common test: each pixel's z at .01 over all pixels (Sidak), passed where 99.75% of them pass.
bool pixels_agree(const Picture& a, const Picture& b) {
  int failed = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (int k = 0; k < 3; ++k) {
        const double variance = std::max(1e-4, double(a.at(x, y)[3 + k]) + b.at(x, y)[3 + k]);
        failed += std::abs(double(a.at(x, y)[k]) - b.at(x, y)[k]) > 5.0 * std::sqrt(variance);
      }
  return failed <= 0.0025 * 3 * a.width * a.height;
}

TEST(BlockTest, AcceptsTwoEstimatesOfOnePicture) {
  for (std::uint32_t seed = 0; seed < 50; ++seed)
    EXPECT_TRUE(blocks_agree(noisy_picture(2 * seed, 1), noisy_picture(2 * seed + 1, 1))) << seed;
}

TEST(BlockTest, RejectsABiasOfOnePercentThatPixelsDoNotShow) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const Picture reference = noisy_picture(2 * seed, 1);
    EXPECT_FALSE(blocks_agree(noisy_picture(2 * seed + 1, 1.01f), reference)) << seed;
    EXPECT_FALSE(blocks_agree(noisy_picture(2 * seed + 1, 0.99f), reference)) << seed;
    EXPECT_TRUE(pixels_agree(noisy_picture(2 * seed + 1, 1.1f), reference)) << seed;
  }
}

TEST(BlockTest, RejectsOneBlockAndSinglePixels) {
  const Picture reference = noisy_picture(1, 1);
  Picture p = noisy_picture(2, 1);
  for (int y = 64; y < 96; ++y)
    for (int x = 32; x < 64; ++x) p.at(x, y)[1] *= 1.05f;
  EXPECT_FALSE(blocks_agree(p, reference));
  p = noisy_picture(2, 1);
  EXPECT_TRUE(blocks_agree(p, reference, 2));
  p.at(5, 6)[0] = 40;
  EXPECT_FALSE(blocks_agree(p, reference, 2));
  p.at(5, 6)[0] = NAN;
  EXPECT_FALSE(blocks_agree(p, reference));
}

TEST(BlockTest, EqualPicturesWithoutNoiseAgree) {
  Picture p = noisy_picture(3, 1);
  for (int i = 0; i < 128 * 128; ++i)
    for (int k = 3; k < 6; ++k) p.pixels[std::size_t(i * 6 + k)] = 0;
  EXPECT_TRUE(blocks_agree(p, p));
  Picture brighter = p;
  for (int i = 0; i < 128 * 128; ++i) brighter.pixels[std::size_t(i * 6)] += 1e-4f;
  EXPECT_FALSE(blocks_agree(p, brighter));
}

}  // namespace
}  // namespace parian
