#include "renderer/compare/pixel_errors.h"

#include <cmath>

namespace parian {
namespace {

double relative_square(double t, double r) { return (t - r) * (t - r) / (r * r + 0.01); }

}  // namespace

std::vector<bool> not_finite_pixels(const Picture& picture) {
  const std::size_t channels = picture.channels.size();
  std::vector<bool> found(std::size_t(picture.width) * picture.height);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i)
    if (!std::isfinite(picture.pixels[i])) found[i / channels] = true;
  return found;
}

double relative_mse(const Picture& test, const Picture& reference) {
  double sum = 0;
  for (std::size_t i = 0; i < test.pixels.size(); ++i)
    sum += relative_square(test.pixels[i], reference.pixels[i]);
  return std::isfinite(sum) ? sum / double(test.pixels.size()) : NAN;
}

LargestDifference largest_difference(const Picture& test, const Picture& reference) {
  std::size_t at = 0;
  double largest = -1;
  for (std::size_t i = 0; i < test.pixels.size() && std::isfinite(largest); ++i) {
    const double difference = std::abs(double(test.pixels[i]) - reference.pixels[i]);
    if (difference <= largest) continue;
    largest = difference;
    at = i;
  }
  const std::size_t channels = test.channels.size(), pixel = at / channels, width = std::size_t(test.width);
  return {largest, int(pixel % width), int(pixel / width), test.channels[at % channels]};
}

Plane relative_errors(const Picture& test, const Picture& reference) {
  const std::size_t channels = test.channels.size();
  Plane errors(test.width, test.height);
  for (std::size_t pixel = 0; pixel < errors.values.size(); ++pixel) {
    double sum = 0;
    for (std::size_t i = pixel * channels; i < (pixel + 1) * channels; ++i)
      sum += relative_square(test.pixels[i], reference.pixels[i]);
    errors.values[pixel] = float(std::sqrt(sum / double(channels)));
  }
  return errors;
}

double peak_signal_to_noise(double mean_square, double peak) {
  return 10 * std::log10(peak * peak / mean_square);
}

}  // namespace parian
