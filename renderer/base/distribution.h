/// Discrete and piecewise-constant distributions, built in double (a float sum of many terms drifts).
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "renderer/base/math.h"

namespace parian {

/// Index i with probability proportional to weight i.
class Distribution1D {
 public:
  Distribution1D() = default;
  /// Weights are finite and >= 0. Where all are zero every index is equally likely.
  explicit Distribution1D(std::span<const float> weights);

  int size() const { return int(cdf_.size()) - 1; }
  double total() const { return total_; }
  std::size_t bytes() const { return (cdf_.capacity() + guide_.capacity()) * sizeof(float); }
  /// What bytes() is for so many weights.
  static std::size_t predicted_bytes(std::size_t weights) {
    return (weights + 1) * sizeof(float) * (weights <= kFew ? 1 : 2);
  }
  /// The probability of index i, as sampled: the difference of the stored sums.
  float probability(int i) const { return cdf_[i + 1] - cdf_[i]; }

  struct Sample {
    int index;
    float probability;
    float remainder;  // the rest of u, again uniform in [0, 1)
  };
  Sample sample(float u) const {
    const int i = find(u);
    const float p = probability(i);
    return {i, p, std::clamp((u - cdf_[i]) / p, 0.0f, 0x1.fffffep-1f)};
  }

 private:
  int find(float u) const {
    int i = 0;
    if (size() <= kFew) {
      for (const float sum : few_) i += sum <= u;
      return i;
    }
    const int k = std::min(int(u * float(size())), size() - 1);
    i = int(guide_[k]);
    if (const int last = int(guide_[k + 1]); last - i > kFew) return search(u, i, last);
    // Mostly one step or none: two that cost no branch, since a branch on chance is mispredicted.
    i += cdf_[i + 1] <= u;
    i += cdf_[i + 1] <= u;
    while (cdf_[i + 1] <= u) ++i;
    return i;
  }
  int search(float u, int first, int last) const;

  static constexpr int kFew = 8;
  std::vector<float> cdf_;  // size + 1 values from 0 to 1
  // Where to look for u: the sums after the 0, where they are few, and above every u what is missing; else
  // the index at u = k / size, so that the search for u begins between two of these (Chen and Asau 1974, the
  // guide table).
  std::array<float, kFew> few_;
  std::vector<std::uint32_t> guide_;
  double total_ = 0;
};

/// A piecewise-constant density on the unit square, nx by ny cells.
class Distribution2D {
 public:
  Distribution2D() = default;
  /// `weight(x, y)`, finite and >= 0, is called once per cell, rows in parallel.
  Distribution2D(int nx, int ny, const std::function<float(int, int)>& weight);

  double total() const { return rows_.total(); }  // sum of all weights
  /// Density per unit area at p in [0,1)^2.
  float pdf(const Vec2f& p) const;
  struct Sample {
    Vec2f p;
    float pdf;
  };
  Sample sample(const Vec2f& u) const;

 private:
  int nx_ = 0, ny_ = 0;
  Distribution1D rows_;
  std::vector<Distribution1D> columns_;  // one in each row
};

}  // namespace parian
