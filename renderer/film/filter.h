/// Reconstruction filters, applied by sampling: a camera ray is drawn from the filter around its pixel and
/// counts 1, so a pixel depends on its own samples alone and needs no lock (Ernst et al. 2006, Filter
/// Importance Sampling).
#pragma once

#include <array>
#include <string>

#include "renderer/base/math.h"

namespace parian {

enum class FilterKind : std::uint8_t { blackman_harris, box };

class PixelFilter {
 public:
  /// Radius in pixels: 1.5 for Blackman-Harris, 0.5 for the box.
  explicit PixelFilter(FilterKind kind);

  /// Offset from the pixel's centre, in pixels, distributed as the filter; u in [0,1)^2.
  Vec2f sample(const Vec2f& u) const { return {sample_axis(u.x), sample_axis(u.y)}; }

 private:
  static constexpr int kIntervals = 256;
  /// Distance from the centre at u = (i / kIntervals)^2 / 2, and at 1 - u: closest in the tails, where it
  /// changes most. Linear in between, so that the box is exact.
  float sample_axis(float u) const {
    const float w = 2 * kIntervals * kIntervals * std::min(u, 1 - u);
    const int i = std::min(int(std::sqrt(w)), kIntervals - 1);
    const float x = distance_[i] + (w - float(i * i)) / float(2 * i + 1) * (distance_[i + 1] - distance_[i]);
    return std::copysign(x, u - 0.5f);
  }
  std::array<float, kIntervals + 1> distance_;
};

}  // namespace parian
