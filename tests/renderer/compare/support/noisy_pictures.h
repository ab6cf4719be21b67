/// Pictures made of random samples, with the variance that a renderer would write.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "renderer/base/image.h"

namespace parian {

/// How the samples of a pixel are distributed. Light: exponential, of mean 1. Heavy: one in a thousand has
/// half of the energy, the others are exponential, of mean 1 in all.
enum class Tail { light, heavy };

/// A grey picture of mean `level`, channels Y and variance.Y, from `spp` independent samples a pixel.
inline Picture noisy_picture(Tail tail, int side, int spp, std::uint32_t seed, double level = 1) {
  std::mt19937 engine(seed);
  const double rare = 0.001, exponential_mean = tail == Tail::heavy ? 0.5 : 1;
  const auto pixels = std::size_t(side) * std::size_t(side);
  std::vector<int> found(pixels);
  if (tail == Tail::heavy) {
    std::uniform_int_distribution<std::size_t> anywhere(0, pixels - 1);
    for (int i = std::poisson_distribution<int>(rare * spp * double(pixels))(engine); i > 0; --i)
      ++found[anywhere(engine)];
  }
  std::gamma_distribution<double> sum_of_exponentials(spp, exponential_mean);
  Picture p{side, side, {"Y", "variance.Y"}, {}, {}};
  for (const int k : found) {
    const double bright = 0.5 / rare, sum = sum_of_exponentials(engine) + bright * k;
    // The squares of the exponential samples by their expectation: enough for a variance.
    const double squares = 2 * exponential_mean * exponential_mean * spp + bright * bright * k;
    const double variance = std::max(0.0, squares - sum * sum / spp) / (spp - 1) / spp;
    p.pixels.push_back(float(level * sum / spp));
    p.pixels.push_back(float(level * level * variance));
  }
  return p;
}

}  // namespace parian
