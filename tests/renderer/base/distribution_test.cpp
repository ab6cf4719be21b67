#include "renderer/base/distribution.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1f;

TEST(Distribution1D, ChoosesInProportionToTheWeights) {
  const std::vector<float> weights{1, 0, 3, 0.5f, 0, 0, 10, 2, 0};
  const Distribution1D distribution(weights);
  EXPECT_EQ(distribution.size(), 9);
  EXPECT_DOUBLE_EQ(distribution.total(), 16.5);
  TestRandom random(1);
  std::vector<double> observed(9, 0), expected;
  for (const float w : weights) expected.push_back(100000 * w / 16.5);
  for (int i = 0; i < 100000; ++i) {
    const auto s = distribution.sample(random.next1());
    ++observed[s.index];
    ASSERT_EQ(s.probability, distribution.probability(s.index));
    ASSERT_NEAR(s.probability, weights[s.index] / 16.5, 1e-6);
  }
  EXPECT_TRUE(chi_square(observed, expected));
}

// Catches lower_bound for upper_bound (u = 0, and u on a border, would find an index of weight 0) and a gap
// below 1.
TEST(Distribution1D, NeverChoosesAnIndexOfWeightZero) {
  TestRandom random(2);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<float> weights(1 + int(random.next1() * 40));
    for (float& w : weights) w = random.next1() < 0.5f ? 0 : random.next1();
    weights[int(random.next1() * float(weights.size()))] = 0.3f;
    const Distribution1D distribution(weights);
    const auto check = [&](float u) {
      const auto s = distribution.sample(u);
      ASSERT_GT(weights[s.index], 0) << "u = " << u;
      ASSERT_GT(s.probability, 0);
      ASSERT_TRUE(s.remainder >= 0 && s.remainder < 1);
    };
    check(0);
    check(kBelowOne);
    float border = 0;
    for (int i = 0; i < distribution.size(); ++i) {
      border += distribution.probability(i);
      if (border < 1) check(border);
      check(std::min(std::nextafter(border, 0.0f), kBelowOne));
    }
    for (int i = 0; i < 1000; ++i) check(random.next1());
  }
}

// Catches a remainder that is u itself (biased), or that is not divided by the probability.
TEST(Distribution1D, RemainderIsUniformWithinEveryIndex) {
  const std::vector<float> weights{1, 4, 0, 2, 9};
  const Distribution1D distribution(weights);
  TestRandom random(3);
  constexpr int kSamples = 200000, kBins = 8;
  std::vector<double> observed(5 * kBins, 0), expected(5 * kBins);
  for (int i = 0; i < 5 * kBins; ++i) expected[i] = kSamples * weights[i / kBins] / 16 / kBins;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = distribution.sample(random.next1());
    ++observed[s.index * kBins + int(s.remainder * kBins)];
  }
  EXPECT_TRUE(chi_square(observed, expected));
}

// Catches 0/0.
TEST(Distribution1D, OfZeroWeightsIsUniform) {
  const Distribution1D distribution(std::vector<float>(4, 0));
  EXPECT_EQ(distribution.total(), 0);
  for (int i = 0; i < 4; ++i) {
    EXPECT_FLOAT_EQ(distribution.probability(i), 0.25f);
    EXPECT_EQ(distribution.sample((float(i) + 0.5f) / 4).index, i);
  }
  EXPECT_EQ(distribution.sample(kBelowOne).index, 3);
}

TEST(Distribution1D, OfOneWeightAlwaysChoosesIt) {
  for (const float weight : {1e-38f, 1.0f, 1e38f}) {
    const auto s = Distribution1D(std::vector<float>{weight}).sample(0.7f);
    EXPECT_EQ(s.index, 0);
    EXPECT_EQ(s.probability, 1);
    EXPECT_FLOAT_EQ(s.remainder, 0.7f);
  }
}

// A sequential sum in float is 36% low.
TEST(Distribution1D, SumsManyWeightsInDouble) {
  constexpr int kCount = 33'000'000;
  const Distribution1D distribution(std::vector<float>(kCount, 0.1f));
  EXPECT_NEAR(distribution.total() / (0.1f * double(kCount)), 1, 1e-12);
  for (const float u : {0.1f, 0.25f, 0.5f, 0.9f})
    EXPECT_NEAR(distribution.sample(u).index / double(kCount), u, 1e-6);
}

TEST(Distribution2D, SamplesWithItsDensity) {
  constexpr int kX = 7, kY = 5, kSamples = 200000;
  const auto weight = [](int x, int y) { return y == 2 ? 0 : float((x * x + 3 * y) % 11); };
  const Distribution2D distribution(kX, kY, weight);
  double total = 0;
  for (int y = 0; y < kY; ++y)
    for (int x = 0; x < kX; ++x) total += weight(x, y);
  EXPECT_DOUBLE_EQ(distribution.total(), total);

  TestRandom random(4);
  // Two by two bins in each cell: the point is uniform within.
  std::vector<double> observed(4 * kX * kY, 0), expected(4 * kX * kY, 0);
  for (int y = 0; y < 2 * kY; ++y)
    for (int x = 0; x < 2 * kX; ++x) {
      const Vec2f center((float(x) + 0.5f) / (2 * kX), (float(y) + 0.5f) / (2 * kY));
      EXPECT_NEAR(distribution.pdf(center), weight(x / 2, y / 2) / total * kX * kY, 1e-5);
      expected[y * 2 * kX + x] = kSamples * distribution.pdf(center) / (4 * kX * kY);
    }
  for (int i = 0; i < kSamples; ++i) {
    const auto s = distribution.sample(random.next2());
    ++observed[int(s.p.y * 2 * kY) * 2 * kX + int(s.p.x * 2 * kX)];
    ASSERT_FLOAT_EQ(s.pdf, distribution.pdf(s.p));
  }
  EXPECT_TRUE(chi_square(observed, expected));
}

// Uniform sampling finds this texel with 4.8e-7; it holds .8266 of the power.
TEST(Distribution2D, FindsTheSun) {
  constexpr int kX = 2048, kY = 1024, kSunX = 1234, kSunY = 300, kSamples = 40000;
  const Distribution2D distribution(kX, kY,
                                    [](int x, int y) { return x == kSunX && y == kSunY ? 1e7f : 1.0f; });
  const double share = 1e7 / (1e7 + kX * kY - 1);
  EXPECT_NEAR(distribution.total(), 1e7 + kX * kY - 1, 1);
  const Vec2f sun((kSunX + 0.5f) / kX, (kSunY + 0.5f) / kY);
  EXPECT_NEAR(distribution.pdf(sun) / (double(kX) * kY), share, 1e-5);
  TestRandom random(5);
  Statistics found;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = distribution.sample(random.next2());
    found.add(int(s.p.x * kX) == kSunX && int(s.p.y * kY) == kSunY);
  }
  EXPECT_TRUE(mean_is(found, share, 0.02));
}

TEST(Distribution2D, OfZeroWeightsIsUniform) {
  const Distribution2D distribution(3, 2, [](int, int) { return 0.0f; });
  EXPECT_EQ(distribution.total(), 0);
  EXPECT_NEAR(distribution.pdf({0.5f, 0.5f}), 1, 1e-6);
  const auto s = distribution.sample({kBelowOne, kBelowOne});
  EXPECT_NEAR(s.pdf, 1, 1e-6);
  EXPECT_TRUE(s.p.x <= 1 && s.p.y <= 1);
}

TEST(Distribution2D, NeverChoosesACellOfWeightZero) {
  const auto weight = [](int x, int y) { return (x + y) % 3 == 1 ? 1.0f : 0.0f; };
  const Distribution2D distribution(64, 33, weight);
  TestRandom random(6);
  for (int i = 0; i < 100000; ++i) {
    const float edges[] = {0, 0.5f, kBelowOne};
    Vec2f u = random.next2();
    if (i % 10 == 0) u.x = edges[i / 10 % 3];
    if (i % 11 == 0) u.y = edges[i / 11 % 3];
    ASSERT_GT(distribution.sample(u).pdf, 0);
  }
}

// The guide table against a walk along the sums: equal weights, few that are large, one that holds nearly
// all, ends that have none. Caught: the guide of the next step, one that is short of its last entry, a walk
// past the last index.
TEST(Distribution1D, FindsTheIndexOfAWalkAlongTheSums) {
  TestRandom random(11);
  for (const int size : {1, 2, 7, 8, 9, 10, 100, 1000, 3001})
    for (const float power : {0.0f, 1.0f, 12.0f}) {
      std::vector<float> weights(size);
      for (float& w : weights) w = random.next1() < 0.2f ? 0 : std::pow(random.next1(), power);
      weights[size / 2] = power > 2 ? 1e6f : 1;
      const Distribution1D d(weights);
      std::vector<double> sums(1, 0);
      for (int i = 0; i < size; ++i) sums.push_back(sums.back() + d.probability(i));
      for (int i = 0; i < 5000; ++i) {
        const float u = i == 0 ? 0 : i == 1 ? 0x1.fffffep-1f : i < 500 ? float(i) / 500 : random.next1();
        const Distribution1D::Sample s = d.sample(u);
        ASSERT_TRUE(s.index >= 0 && s.index < size);
        ASSERT_GT(s.probability, 0);
        // The sums are floats, and this test's are made of their differences.
        ASSERT_LE(sums[s.index], u + 1e-6) << size << " " << u;
        ASSERT_GE(sums[s.index + 1], u - 1e-6) << size << " " << u;
      }
    }
}

}  // namespace
}  // namespace parian
