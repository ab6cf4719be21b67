#include "renderer/film/filter.h"

#include <vector>

namespace parian {
namespace {

/// The four-term Blackman-Harris window over [-1, 1] (Harris 1978, table 1).
double blackman_harris(double x) {
  const double phase = std::numbers::pi * (x + 1);
  return 0.35875 - 0.48829 * std::cos(phase) + 0.14128 * std::cos(2 * phase) - 0.01168 * std::cos(3 * phase);
}

}  // namespace

PixelFilter::PixelFilter(FilterKind kind) {
  const double radius = kind == FilterKind::box ? 0.5 : 1.5;
  constexpr int kSteps = 1 << 14;
  std::vector<double> cdf(kSteps + 1, 0);
  for (int i = 0; i < kSteps; ++i) {
    const double x = 2 * (i + 0.5) / kSteps - 1;
    cdf[i + 1] = cdf[i] + (kind == FilterKind::box ? 1 : blackman_harris(x));
  }
  int step = 0;
  for (int i = 0; i <= kIntervals; ++i) {
    const double target = cdf[kSteps] * 0.5 * i * i / (double(kIntervals) * kIntervals);
    while (step < kSteps - 1 && cdf[step + 1] < target) ++step;
    const double within = (target - cdf[step]) / (cdf[step + 1] - cdf[step]);
    distance_[i] = float(radius * (1 - 2 * (step + within) / kSteps));
  }
}

}  // namespace parian
