#include "renderer/session/adaptive.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace parian {
namespace {

/// How many samples each block deserves, but for a factor: the standard deviation of one over the root of its
/// cost, averaged over the block and its neighbours.
std::vector<double> deserved_samples(const BlockNoise& blocks) {
  std::vector<double> smooth(blocks.error.size());
  for (int y = 0; y < blocks.rows; ++y)
    for (int x = 0; x < blocks.columns; ++x) {
      double sum = 0;
      int count = 0;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, blocks.rows - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, blocks.columns - 1); ++u, ++count) {
          const std::size_t b = std::size_t(v) * blocks.columns + u;
          sum += std::sqrt(blocks.error[b] * blocks.samples[b] / blocks.cost[b]);
        }
      smooth[std::size_t(y) * blocks.columns + x] = sum / count;
    }
  return smooth;
}

/// To the nearest of 2^k and 3 * 2^k: the sequence is most even there.
std::uint32_t round_number(double samples) {
  const auto n = std::uint32_t(std::clamp(samples + .5, 1.0, 1e9));
  const std::uint32_t step = std::max(std::bit_floor(n) / 2, 1u);
  return (n + step / 2) / step * step;
}

}  // namespace

std::vector<std::uint32_t> plan_adaptive_pass(const BlockNoise& blocks, double target,
                                              std::uint32_t max_samples) {
  constexpr double kLeastShare = .125, kMostGrowth = 1.5, kLeastGrowth = 1.0625;
  const Noise noise = picture_noise(blocks);
  const std::size_t count = blocks.error.size();
  double spent = 0;
  for (std::size_t b = 0; b < count; ++b) spent += blocks.weight[b] * blocks.samples[b];
  if (noise.bound <= target || spent > max_samples - .5) return {};

  const std::vector<double> deserved = deserved_samples(blocks);
  double mean_deserved = 0, needed = 0;
  for (std::size_t b = 0; b < count; ++b) mean_deserved += blocks.weight[b] * deserved[b];
  std::vector<double> share(count);  // of the mean number of samples
  for (std::size_t b = 0; b < count; ++b) {
    share[b] = std::max(deserved[b] / mean_deserved, kLeastShare);
    needed += blocks.weight[b] * blocks.error[b] * blocks.samples[b] / share[b];
  }
  // `needed` / n is the picture's squared error once the mean pixel has n samples, so distributed.
  const double ratio = noise.bound / noise.estimate / target;
  const double mean = std::min(std::clamp(needed * ratio * ratio, kLeastGrowth * spent, kMostGrowth * spent),
                               double(max_samples));
  std::vector<std::uint32_t> plan(count);
  for (std::size_t b = 0; b < count; ++b)
    plan[b] = std::max(blocks.samples[b], round_number(mean * share[b]));
  return plan == blocks.samples ? std::vector<std::uint32_t>() : plan;
}

}  // namespace parian
