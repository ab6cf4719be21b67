#include "renderer/base/random.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr auto kSobol = SamplerKind::sobol, kIndependent = SamplerKind::independent;

std::uint32_t random_bits(TestRandom& random) {
  return std::uint32_t(random.next1() * 0x1p16f) << 16 | std::uint32_t(random.next1() * 0x1p16f);
}

// Catches x * 2^-32, which rounds to 1.
TEST(ToUnitFloat, IsNeverOne) {
  EXPECT_EQ(to_unit_float(0), 0);
  EXPECT_EQ(to_unit_float(0x80000000u), 0.5f);
  EXPECT_LT(to_unit_float(0xffffffffu), 1);
  EXPECT_EQ(to_unit_float(0xffffffffu), std::nextafter(1.0f, 0.0f));
}

TEST(ReverseBits, ReversesAndIsItsOwnInverse) {
  EXPECT_EQ(reverse_bits(1), 0x80000000u);
  EXPECT_EQ(reverse_bits(0x12345678u), 0x1e6a2c48u);
  TestRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t x = random_bits(random);
    std::uint32_t expected = 0;
    for (int bit = 0; bit < 32; ++bit) expected |= (x >> bit & 1) << (31 - bit);
    ASSERT_EQ(reverse_bits(x), expected);
  }
}

// Catches a hash that maps two inputs to one output, or leaves output bits that follow an input bit.
TEST(Hash32, IsAPermutationThatMixesEveryBit) {
  std::set<std::uint32_t> seen;
  for (std::uint32_t i = 0; i < 100000; ++i) seen.insert(hash32(i));
  EXPECT_EQ(seen.size(), 100000u);
  TestRandom random(2);
  for (int in = 0; in < 32; ++in) {
    std::array<int, 32> flips{};
    for (int i = 0; i < 2000; ++i) {
      const std::uint32_t x = random_bits(random), changed = hash32(x) ^ hash32(x ^ (1u << in));
      for (int out = 0; out < 32; ++out) flips[out] += changed >> out & 1;
    }
    for (int out = 0; out < 32; ++out) EXPECT_NEAR(flips[out] / 2000.0, 0.5, 0.1) << in << " to " << out;
  }
}

// The direction numbers of the second Sobol dimension by their recurrence (polynomial x + 1): m_i = 2 m_(i-1)
// ^ m_(i-1).
std::uint32_t sobol1_by_direction_numbers(std::uint32_t index) {
  std::uint32_t m = 1, result = 0;
  for (int i = 1; i <= 32; ++i) {
    if (index >> (i - 1) & 1) result ^= m << (32 - i);
    m ^= m << 1;
  }
  return result;
}

// Catches a wrong mask or shift in the bit-parallel form.
TEST(Sobol1Reversed, EqualsTheDirectionNumbers) {
  for (std::uint32_t i = 0; i < 4096; ++i)
    ASSERT_EQ(reverse_bits(sobol1_reversed(i)), sobol1_by_direction_numbers(i)) << i;
  TestRandom random(3);
  for (int i = 0; i < 4096; ++i) {
    const std::uint32_t index = random_bits(random);
    ASSERT_EQ(reverse_bits(sobol1_reversed(index)), sobol1_by_direction_numbers(index)) << index;
  }
}

// Reversed, an elementary interval of size 2^-k is what shares the k lowest bits. Catches an operation that
// carries from high bits to low ones, an even factor (no permutation), and a scramble that does nothing to a
// bit.
TEST(ScrambleReversed, PermutesElementaryIntervals) {
  TestRandom random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const std::uint32_t seed = random_bits(random);
    for (int k = 1; k <= 10; ++k) {
      std::vector<bool> taken(std::size_t(1) << k, false);
      const std::uint32_t mask = (1u << k) - 1;
      for (std::uint32_t low = 0; low <= mask; ++low) {
        const std::uint32_t a = scramble_reversed(low, seed) & mask;
        const std::uint32_t b = scramble_reversed(low | (random_bits(random) & ~mask), seed) & mask;
        ASSERT_EQ(a, b);
        ASSERT_FALSE(taken[a]);
        taken[a] = true;
      }
    }
  }
}

TEST(ScrambleReversed, FlipsEveryBitForHalfOfTheSeeds) {
  TestRandom random(5);
  constexpr int kTrials = 20000;
  std::array<int, 32> flips{};
  for (int i = 0; i < kTrials; ++i) {
    const std::uint32_t x = random_bits(random), changed = x ^ scramble_reversed(x, random_bits(random));
    for (int bit = 0; bit < 32; ++bit) flips[bit] += changed >> bit & 1;
  }
  for (int bit = 0; bit < 32; ++bit)
    EXPECT_NEAR(flips[bit] / double(kTrials), 0.5, 4.5 * 0.5 / std::sqrt(kTrials)) << bit;
}

std::vector<Vec2f> pair_of(std::uint32_t seed, int x, int y, std::uint32_t first, std::uint32_t count,
                           int pair) {
  std::vector<Vec2f> points;
  for (std::uint32_t i = first; i < first + count; ++i) {
    Sampler sampler(kSobol, seed, x, y, i);
    for (int skipped = 0; skipped < pair; ++skipped) sampler.next2();
    points.push_back(sampler.next2());
  }
  return points;
}

// Every block of 2^k samples of every pair has one point in each elementary interval 2^-a by 2^-(k-a).
// Catches two scrambles of different order for x and y, an index shuffle that tears blocks apart, and a lost
// bit.
TEST(Sampler, StratifiesEveryPairInAllElementaryIntervals) {
  TestRandom random(6);
  for (int trial = 0; trial < 12; ++trial) {
    const std::uint32_t seed = random_bits(random);
    const int x = int(random.next1() * 4096), y = int(random.next1() * 4096), pair = int(random.next1() * 24);
    for (int k = 0; k <= 10; ++k) {
      const std::uint32_t count = 1u << k, first = count * std::uint32_t(random.next1() * 8);
      const std::vector<Vec2f> points = pair_of(seed, x, y, first, count, pair);
      for (int a = 0; a <= k; ++a) {
        std::vector<bool> taken(count, false);
        for (const Vec2f& p : points) {
          const auto i = std::size_t(std::ldexp(p.x, a)), j = std::size_t(std::ldexp(p.y, k - a));
          const std::size_t cell = i << (k - a) | j;
          ASSERT_FALSE(taken[cell]) << "pair " << pair << ", " << count << " samples, a = " << a;
          taken[cell] = true;
        }
      }
    }
  }
}

TEST(Sampler, StaysBelowOne) {
  for (const SamplerKind kind : {kSobol, kIndependent})
    for (std::uint32_t i = 0; i < 200000; ++i) {
      const Vec2f u = Sampler(kind, 7, int(i % 512), int(i / 512), i).next2();
      ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
    }
}

TEST(Sampler, DependsOnSeedPixelSampleAndDimensionOnly) {
  const auto first = [](std::uint32_t seed, int x, int y, std::uint32_t sample) {
    return Sampler(kSobol, seed, x, y, sample).next2();
  };
  EXPECT_EQ(first(1, 2, 3, 4), first(1, 2, 3, 4));
  EXPECT_NE(first(1, 2, 3, 4), first(2, 2, 3, 4));
  EXPECT_NE(first(1, 2, 3, 4), first(1, 3, 3, 4));
  EXPECT_NE(first(1, 2, 3, 4), first(1, 2, 4, 4));
  EXPECT_NE(first(1, 2, 3, 4), first(1, 3, 2, 4));
  EXPECT_NE(first(1, 2, 3, 4), first(1, 2, 3, 5));
  Sampler one(kSobol, 1, 2, 3, 4), two(kSobol, 1, 2, 3, 4);
  one.next1();
  two.next2();
  EXPECT_EQ(one.next2(), two.next2()) << "next1() takes one dimension pair, as next2() does";
}

// The first samples of 2^16 pixels are uniform in the square, in every pair of dimensions.
TEST(Sampler, IsUniformOverPixels) {
  for (const SamplerKind kind : {kSobol, kIndependent}) {
    std::array<std::vector<double>, 4> counts;
    counts.fill(std::vector<double>(256, 0));
    for (int y = 0; y < 256; ++y)
      for (int x = 0; x < 256; ++x) {
        Sampler sampler(kind, 8, x, y, 5);
        for (std::vector<double>& pair : counts) {
          const Vec2f u = sampler.next2();
          ++pair[int(u.x * 16) * 16 + int(u.y * 16)];
        }
      }
    for (const std::vector<double>& pair : counts)
      EXPECT_TRUE(chi_square(pair, std::vector<double>(256, 256), 8));
  }
}

constexpr int kDimensions = 32, kPoints = 64;

std::array<std::vector<float>, kDimensions> dimensions_of(SamplerKind kind, std::uint32_t seed, int x,
                                                          int y) {
  std::array<std::vector<float>, kDimensions> u;
  for (std::uint32_t i = 0; i < kPoints; ++i) {
    Sampler sampler(kind, seed, x, y, i);
    for (int d = 0; d < kDimensions; d += 2) {
      const Vec2f pair = sampler.next2();
      u[d].push_back(pair.x);
      u[d + 1].push_back(pair.y);
    }
  }
  return u;
}

// Mean square of the correlation of two dimensions over n samples, times n - 1: 1 for independent numbers. A
// nested shuffle moves whole blocks, so it is more for an ideal Owen scramble: 1.56, by a simulation with
// true random trees.
double expected_square(SamplerKind kind) { return kind == kSobol ? 1.56 : 1; }

// Catches unscrambled Sobol
// dimensions, whose worst pairs reach .997 at 64 points, and scrambles of x and y that share bits.
TEST(Sampler, NoTwoDimensionsCorrelate) {
  for (const SamplerKind kind : {kSobol, kIndependent}) {
    double worst = 0;
    Statistics squares;
    for (int pixel = 0; pixel < 50; ++pixel) {
      const auto u = dimensions_of(kind, 9, pixel * 37, pixel * 11);
      for (int a = 0; a < kDimensions; ++a)
        for (int b = a + 1; b < kDimensions; ++b) {
          const double r = correlation(u[a], u[b]);
          worst = std::max(worst, std::abs(r));
          if (a / 2 != b / 2) squares.add(r * r);
        }
    }
    EXPECT_LT(worst, 0.75);
    EXPECT_NEAR(squares.mean() * (kPoints - 1) / expected_square(kind), 1, 0.1);
  }
}

// Catches a seed that is a plain function of the pixel's number.
TEST(Sampler, NeighbouringPixelsAndSeedsDoNotCorrelate) {
  for (const SamplerKind kind : {kSobol, kIndependent}) {
    const auto base = [&](int dx, int dy, std::uint32_t seed, int dimension) {
      std::vector<float> values;
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          Sampler sampler(kind, seed, x + dx, y + dy, 0);
          for (int skipped = 0; skipped < dimension; ++skipped) sampler.next1();
          values.push_back(sampler.next1());
        }
      return values;
    };
    for (int dimension = 0; dimension < 4; ++dimension) {
      const std::vector<float> here = base(0, 0, 10, dimension);
      for (const auto& [dx, dy] : {std::pair(1, 0), {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 16}})
        EXPECT_LT(std::abs(correlation(here, base(dx, dy, 10, dimension))), 4.5 / 64) << dx << " " << dy;
      EXPECT_LT(std::abs(correlation(here, base(0, 0, 11, dimension))), 4.5 / 64);
    }
    Statistics squares;
    for (int x = 0; x < 200; ++x) {
      const auto a = dimensions_of(kind, 12, x, 0), b = dimensions_of(kind, 12, x + 1, 0);
      for (int d = 0; d < kDimensions; ++d) squares.add(std::pow(correlation(a[d], b[d]), 2));
    }
    EXPECT_NEAR(squares.mean() * (kPoints - 1) / expected_square(kind), 1, 0.1);
  }
}

/// Slope of log RMSE over log n of the mean of a smooth function of one pair.
double convergence_slope(SamplerKind kind, int pair) {
  const auto f = [](const Vec2f& u) { return std::exp(-double(u.x)) * std::sin(3.0 * u.y); };
  const double truth = (1 - std::exp(-1.0)) * (1 - std::cos(3.0)) / 3;
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  int n = 0;
  for (int k = 4; k <= 10; ++k, ++n) {
    Statistics squares;
    for (int pixel = 0; pixel < 200; ++pixel) {
      double sum = 0;
      for (std::uint32_t i = 0; i < (1u << k); ++i) {
        Sampler sampler(kind, 13, pixel, k, i);
        for (int skipped = 0; skipped < pair; ++skipped) sampler.next2();
        sum += f(sampler.next2());
      }
      squares.add(std::pow(sum / (1 << k) - truth, 2));
    }
    const double y = 0.5 * std::log2(squares.mean());
    sx += k, sy += y, sxx += k * k, sxy += k * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

// Owen-scrambled nets converge as n^-1.5 on smooth functions. A mere random shift (Cranley-Patterson) gives
// about -1.
TEST(Sampler, ConvergesFasterThanIndependentNumbers) {
  for (const int pair : {0, 5}) {
    EXPECT_LT(convergence_slope(kSobol, pair), -1.3);
    EXPECT_NEAR(convergence_slope(kIndependent, pair), -0.5, 0.05);
  }
}

TEST(Sampler, KeyDiffersByPixelSampleAndDimension) {
  std::set<std::uint32_t> seen;
  for (int x = 0; x < 16; ++x)
    for (std::uint32_t i = 0; i < 16; ++i) {
      Sampler sampler(kSobol, 14, x, 0, i);
      for (int d = 0; d < 16; ++d) {
        seen.insert(sampler.key());
        sampler.next1();
      }
    }
  EXPECT_EQ(seen.size(), 4096u);
}

// Caught: lanes exchanged, a sampler whose state does not move on, the seed of the first lane for all, the
// rest of the last group left out. The same bits, whichever instructions the processor has.
TEST(Sampler, SideBySideGivesTheSameNumbers) {
  for (const SamplerKind kind : {kSobol, kIndependent})
    for (int count = 1; count <= 16; ++count) {
      std::vector<Sampler> samplers, alone;
      for (int i = 0; i < count; ++i)
        samplers.emplace_back(kind, 3, i, 7 * i, std::uint32_t(1000 * i + count));
      alone = samplers;
      std::vector<Sampler*> pointers;
      for (Sampler& s : samplers) pointers.push_back(&s);
      for (int draw = 0; draw < 3; ++draw) {
        std::vector<Vec2f> first(count), second(count);
        next2_twice(pointers, first.data(), second.data());
        for (int i = 0; i < count; ++i) {
          ASSERT_EQ(first[i], alone[i].next2()) << count << " " << i;
          ASSERT_EQ(second[i], alone[i].next2()) << count << " " << i;
        }
      }
      for (int i = 0; i < count; ++i) EXPECT_EQ(samplers[i].key(), alone[i].key());
    }
}

}  // namespace
}  // namespace parian
