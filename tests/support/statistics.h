/// Means with their standard errors, and what the tests accept of them.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <span>

#include "renderer/base/random.h"

namespace parian {

/// Independent uniform numbers that owe nothing to the code under test. A test states its seed.
class TestRandom {
 public:
  explicit TestRandom(std::uint32_t seed) : engine_(seed) {}
  float next1() { return to_unit_float(std::uint32_t(engine_())); }
  Vec2f next2() {
    const float x = next1();
    return {x, next1()};
  }
  /// A uniform direction.
  Vec3f direction() {
    const double z = 2.0 * next1() - 1, phi = 2 * std::numbers::pi * next1(), r = std::sqrt(1 - z * z);
    return {float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)};
  }

 private:
  std::mt19937 engine_;
};

/// Mean and variance of values added one by one (Welford).
class Statistics {
 public:
  void add(double x) {
    ++n_;
    const double delta = x - mean_;
    mean_ += delta / n_;
    squares_ += delta * (x - mean_);
  }
  double count() const { return n_; }
  double mean() const { return mean_; }
  /// Unbiased.
  double variance() const { return n_ < 2 ? 0 : squares_ / (n_ - 1); }
  /// Standard error of the mean.
  double standard_error() const { return std::sqrt(variance() / n_); }

 private:
  double n_ = 0, mean_ = 0, squares_ = 0;
};

/// |mean - truth| < 4.5 standard errors, where these are small enough to see an error of `tolerance`
/// (relative; absolute where truth is 0).
inline testing::AssertionResult mean_is(const Statistics& s, double truth, double tolerance) {
  const double allowed = 4.5 * s.standard_error(), scale = truth == 0 ? 1 : std::abs(truth);
  if (!(allowed <= tolerance * scale))
    return testing::AssertionFailure() << "too few samples: 4.5 standard errors are " << allowed
                                       << ", tolerance " << tolerance * scale << ", mean " << s.mean();
  // An estimator without variance still rounds.
  if (std::abs(s.mean() - truth) < allowed + 1e-6 * scale) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "mean " << s.mean() << " +- " << s.standard_error() << ", expected "
                                     << truth << ": " << (s.mean() - truth) / s.standard_error()
                                     << " standard errors off";
}

/// Pearson's coefficient of two sequences of equal length.
inline double correlation(std::span<const float> a, std::span<const float> b) {
  Statistics sa, sb;
  double product = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sa.add(a[i]);
    sb.add(b[i]);
    product += double(a[i]) * b[i];
  }
  const double n = double(a.size());
  return (product - n * sa.mean() * sb.mean()) / ((n - 1) * std::sqrt(sa.variance() * sb.variance()));
}

}  // namespace parian
