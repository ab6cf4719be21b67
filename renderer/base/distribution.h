/// Discrete and piecewise-constant distributions, built in double (a float sum of many terms drifts).
#pragma once

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
    if (size() > 8) return search(u);
    int i = 0;  // counting is quicker than searching, and does not mispredict
    for (int k = 1; k < size(); ++k) i += cdf_[k] <= u;
    return i;
  }
  int search(float u) const;

  std::vector<float> cdf_;  // size + 1 values from 0 to 1
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
