#include "renderer/session/adaptive.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace parian {
namespace {

/// How many samples each block deserves, but for a factor, averaged over the block and its neighbours: those
/// with which a ray more brings as much anywhere, if the squared error falls as n^-kRate. Samples as they
/// should be are a fixed point whatever the rate really is (1 for independent samples, up to 3 for Sobol
/// points and smooth functions); the larger kRate is, the more carefully passes come near it, which cannot
/// take samples back.
std::vector<double> deserved_samples(const BlockNoise& blocks) {
  constexpr double kRate = 1.5;
  std::vector<double> smooth(blocks.error.size());
  for (int y = 0; y < blocks.rows; ++y)
    for (int x = 0; x < blocks.columns; ++x) {
      double sum = 0;
      int count = 0;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, blocks.rows - 1); ++v)
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, blocks.columns - 1); ++u, ++count) {
          const std::size_t b = std::size_t(v) * blocks.columns + u;
          sum += std::pow(blocks.error[b] * std::pow(blocks.samples[b], kRate) / blocks.cost[b],
                          1 / (1 + kRate));
        }
      smooth[std::size_t(y) * blocks.columns + x] = sum / count;
    }
  return smooth;
}

double mean_samples(const BlockNoise& blocks, const std::vector<std::uint32_t>& samples) {
  double mean = 0;
  for (std::size_t b = 0; b < samples.size(); ++b) mean += blocks.weight[b] * samples[b];
  return mean;
}

/// The nearest of 2^k and 3 * 2^k, where the sequence is most even; no less than a block has.
std::vector<std::uint32_t> make_plan(const BlockNoise& blocks, const std::vector<double>& share,
                                     double mean) {
  std::vector<std::uint32_t> plan(share.size());
  for (std::size_t b = 0; b < plan.size(); ++b) {
    const auto n = std::uint32_t(std::clamp(mean * share[b] + .5, 1.0, 1e9));
    const std::uint32_t step = std::max(std::bit_floor(n) / 2, 1u);
    plan[b] = std::max(blocks.samples[b], (n + step / 2) / step * step);
  }
  return plan;
}

}  // namespace

std::vector<std::uint32_t> plan_adaptive_pass(const BlockNoise& blocks, double target,
                                              std::uint32_t max_samples) {
  constexpr double kLeastShare = .125, kMostGrowth = 1.5, kLeastGrowth = 1.0625;
  const Noise noise = picture_noise(blocks);
  const std::size_t count = blocks.error.size();
  const double spent = mean_samples(blocks, blocks.samples);
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
  double mean = std::clamp(needed * ratio * ratio, kLeastGrowth * spent, kMostGrowth * spent);
  for (;; mean *= kLeastGrowth) {
    std::vector<std::uint32_t> plan = make_plan(blocks, share, std::min(mean, double(max_samples)));
    if (plan != blocks.samples) return plan;
    if (mean >= max_samples) return {};
  }
}

}  // namespace parian
