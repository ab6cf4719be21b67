#include "renderer/film/noise.h"

#include <algorithm>
#include <cmath>

namespace parian {

Noise picture_noise(const BlockNoise& blocks) {
  const std::size_t count = blocks.error.size();
  double mean = 0, most = 0, squares = 0;
  for (std::size_t b = 0; b < count; ++b) {
    mean += blocks.weight[b] * blocks.error[b];
    most += blocks.weight[b] * blocks.most_error[b];
    squares += blocks.weight[b] * blocks.most_error[b] * blocks.most_error[b];
  }
  if (!std::isfinite(mean)) return {INFINITY, INFINITY};
  // Of one block nothing is known but its error: it counts as if the next could have twice as much.
  const double spread = count > 1 ? std::max(0.0, squares - most * most) / double(count - 1) : most * most;
  return {std::sqrt(mean), std::sqrt(most + kNoiseQuantile * std::sqrt(spread))};
}

}  // namespace parian
