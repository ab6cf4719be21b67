/// Numbers of the difference of two pictures of equal size and channels, pixel by pixel.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "renderer/base/image.h"
#include "renderer/compare/plane.h"

namespace parian {

/// Whether each pixel has a channel that is NaN or Inf.
std::vector<bool> not_finite_pixels(const Picture& picture);

/// The mean over pixels and channels of (t - r)^2 / (r^2 + 0.01) (Rousselle, Knaus and Zwicker 2011,
/// "Adaptive Sampling and Reconstruction using Greedy Error Minimization"). NaN where a value is not finite.
double relative_mse(const Picture& test, const Picture& reference);

/// The largest |t - r|, and where. A difference that is not finite is larger than any that is; of equal ones
/// the first counts.
struct LargestDifference {
  double difference = 0;
  int x = 0, y = 0;
  std::string channel;
};
LargestDifference largest_difference(const Picture& test, const Picture& reference);

/// For each pixel, the root of relative_mse() of its channels.
Plane relative_errors(const Picture& test, const Picture& reference);

/// 10 log10(peak^2 / mean_square) in dB; infinite where the mean is 0.
double peak_signal_to_noise(double mean_square, double peak);

}  // namespace parian
