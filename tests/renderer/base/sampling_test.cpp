#include "renderer/base/sampling.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr int kSamples = 200000;
constexpr float kBelowOne = 0x1.fffffep-1f;

// --- The test of the tests ---

// Values of standard tables: 5% at 3.841459 (1 degree of freedom) and 124.342 (100), 1% at 135.807.
TEST(ChiSquare, HasTheRightTail) {
  EXPECT_NEAR(gamma_q(0.5, 0.5 * 3.841459), 0.05, 1e-7);
  EXPECT_NEAR(gamma_q(50, 0.5 * 124.342), 0.05, 1e-5);
  EXPECT_NEAR(gamma_q(50, 0.5 * 135.807), 0.01, 1e-5);
  EXPECT_NEAR(gamma_q(1, 3), std::exp(-3.0), 1e-12);
  EXPECT_EQ(gamma_q(3, 0), 1);
}

// 26000 samples over 100 degrees of freedom find errors of 5% in a cell, 660000 of 1%.
TEST(ChiSquare, FindsSmallErrorsAndAcceptsTheTruth) {
  for (const auto& [samples, error] : {std::pair(52000, 0.06), {1300000, 0.012}}) {
    TestRandom random(1);
    std::vector<double> observed(101, 0), right(101, samples / 101.0), wrong = right;
    for (int i = 0; i < samples; ++i) ++observed[int(random.next1() * 101)];
    for (int i = 0; i < 100; ++i) wrong[i] *= i % 2 ? 1 + error : 1 - error;
    EXPECT_TRUE(chi_square(observed, right));
    EXPECT_FALSE(chi_square(observed, wrong));
  }
}

TEST(ChiSquare, RejectsSamplesWhereThereAreNone) {
  EXPECT_FALSE(chi_square(std::vector<double>{10, 500, 490}, std::vector<double>{0, 505, 495}));
  EXPECT_FALSE(chi_square(std::vector<double>{500, 500}, std::vector<double>{450, 450})) << "not normalised";
}

TEST(ChiSquare, RejectsAUniformHemisphereClaimedToBeCosine) {
  TestRandom random(2);
  const auto uniform = [&]() -> std::optional<Vec3f> {
    const Vec3f w = random.direction();
    return Vec3f(w.x, w.y, std::abs(w.z));
  };
  const auto cosine = [](const Vec3f& w) { return std::max(0.0f, w.z) * kInvPi; };
  EXPECT_FALSE(samples_directions(uniform, cosine, {}, kSamples, 1, 1));
  const auto half = [](const Vec3f& w) { return w.z > 0 ? 0.5f * kInvPi : 0; };
  EXPECT_TRUE(samples_directions(uniform, half, {}, kSamples, 1, 1));
  EXPECT_FALSE(samples_directions(
      uniform, [&](const Vec3f& w) { return 2 * half(w); }, {}, kSamples, 1));
}

// --- Warps ---

// Catches r = u and cos = u in place of their square roots. Two axes, so that no cell border hides an error.
TEST(SampleCosineHemisphere, HasItsDensity) {
  for (const Vec3f& axis : {Vec3f(0, 0, 1), Vec3f(0.6f, 0, 0.8f)}) {
    TestRandom random(3);
    const auto sample = [&]() -> std::optional<Vec3f> { return sample_cosine_hemisphere(random.next2()); };
    const auto pdf = [](const Vec3f& w) { return std::max(0.0f, w.z) * kInvPi; };
    EXPECT_TRUE(samples_directions(sample, pdf, {.axis = axis}, kSamples, 2, 1));
  }
}

TEST(SampleSphere, HasItsDensity) {
  for (const Vec3f& axis : {Vec3f(0, 0, 1), Vec3f(0.6f, 0, 0.8f)}) {
    TestRandom random(4);
    const auto sample = [&]() -> std::optional<Vec3f> { return sample_sphere(random.next2()); };
    EXPECT_TRUE(samples_directions(
        sample, [](const Vec3f&) { return 0.25f * kInvPi; }, {.axis = axis}, kSamples, 2, 1));
  }
}

TEST(SampleDirections, AreUnitAndAboveTheHorizonAtTheCorners) {
  for (const float x : {0.0f, 0.5f, kBelowOne})
    for (const float y : {0.0f, 0.5f, kBelowOne}) {
      EXPECT_NEAR(sample_cosine_hemisphere({x, y}).length(), 1, 1e-6);
      EXPECT_GT(sample_cosine_hemisphere({x, y}).z, 0);
      EXPECT_NEAR(sample_sphere({x, y}).length(), 1, 1e-6);
      EXPECT_LE(sample_disk({x, y}).length(), 1 + 1e-6f);
    }
}

// E[r] = 2/3, a quarter lies within half the radius. Catches r = u.
TEST(SampleDisk, IsUniform) {
  TestRandom random(5);
  Statistics radius, inner;
  constexpr int kRings = 10, kSectors = 16;
  std::vector<double> observed(kRings * kSectors, 0), expected(kRings * kSectors);
  for (int i = 0; i < kSamples; ++i) {
    const Vec2f p = sample_disk(random.next2());
    const float r = p.length();
    radius.add(r);
    inner.add(r < 0.5f);
    const int sector = std::min(int((std::atan2(p.y, p.x) * 0.5f * kInvPi + 0.5f) * kSectors), kSectors - 1);
    ++observed[std::min(int(r * kRings), kRings - 1) * kSectors + sector];
  }
  for (int i = 0; i < kRings * kSectors; ++i) {
    const double ring = i / kSectors;
    expected[i] = kSamples * (2 * ring + 1) / (kRings * kRings) / kSectors;
  }
  EXPECT_TRUE(mean_is(radius, 2.0 / 3, 0.005));
  EXPECT_TRUE(mean_is(inner, 0.25, 0.02));
  EXPECT_TRUE(chi_square(observed, expected));
}

// Catches a map that is not area-preserving, and one that leaves the triangle.
TEST(SampleTriangle, IsUniform) {
  TestRandom random(6);
  constexpr int kCells = 16;
  std::vector<double> observed(kCells * kCells, 0), expected(kCells * kCells, 0);
  for (int i = 0; i < kSamples; ++i) {
    const Vec2f b = sample_triangle(random.next2());
    ASSERT_TRUE(b.x >= 0 && b.y >= 0 && b.x + b.y <= 1 + 1e-6f);
    ++observed[std::min(int(b.x * kCells), kCells - 1) * kCells + std::min(int(b.y * kCells), kCells - 1)];
  }
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; i + j < kCells; ++j)
      expected[i * kCells + j] = kSamples * (i + j < kCells - 1 ? 2.0 : 1.0) / (kCells * kCells);
  // The border cell (i, j), i + j = kCells, touches the triangle in one point.
  EXPECT_TRUE(chi_square(observed, expected));
}

// a^2 overflows at 1e20 and underflows at 1e-23.
TEST(PowerHeuristic, NeitherOverflowsNorUnderflows) {
  EXPECT_EQ(power_heuristic(1, 0), 1);
  EXPECT_EQ(power_heuristic(1, 1), 0.5f);
  EXPECT_FLOAT_EQ(power_heuristic(3, 1), 0.9f);
  EXPECT_EQ(power_heuristic(1e20f, 1e20f), 0.5f);
  EXPECT_EQ(power_heuristic(1e-23f, 1e-23f), 0.5f);
  EXPECT_FLOAT_EQ(power_heuristic(1e-23f, 3e-23f), 0.1f);
  EXPECT_EQ(power_heuristic(1e20f, 1e-20f), 1);
  EXPECT_EQ(power_heuristic(1e-20f, 1e20f), 0);
  EXPECT_EQ(power_heuristic(1, kInfinity), 0);
  TestRandom random(7);
  for (int i = 0; i < 1000; ++i) {
    const float a = std::pow(10.0f, 60 * random.next1() - 30),
                b = a * std::pow(10.0f, 8 * random.next1() - 4);
    ASSERT_NEAR(power_heuristic(a, b) + power_heuristic(b, a), 1, 1e-6);
  }
}

// Also where a square would overflow or vanish.
TEST(PowerHeuristic, OverTheDensityIsOneDivisionLess) {
  for (const float a : {1e-25f, 1e-3f, 1.0f, 7.5f, 1e12f, 1e30f})
    for (const float b : {0.0f, 1e-25f, 1e-3f, 1.0f, 3.0f, 1e12f, 1e30f}) {
      const double expected = 1 / (double(a) + double(b) * double(b) / double(a));
      ASSERT_NEAR(power_heuristic_over_pdf(a, b) / expected, 1, expected > 1e-37 ? 1e-6 : 1) << a << " " << b;
    }
}

}  // namespace
}  // namespace parian
