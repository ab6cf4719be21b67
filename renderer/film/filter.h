/// Reconstruction filters, applied by sampling: a camera ray is drawn from the filter around its pixel and counts 1, so
/// a pixel depends on its own samples alone and needs no lock (Ernst et al. 2006, Filter Importance Sampling).
#pragma once

#include <array>
#include <string>

#include "renderer/base/math.h"

namespace parian {

enum class FilterKind : std::uint8_t { blackman_harris, box };

class PixelFilter {
 public:
  /// `radius` in pixels; by default 1.5 for Blackman-Harris and 0.5 for the box.
  explicit PixelFilter(FilterKind kind);

  /// Offset from the pixel's centre, in pixels, distributed as the filter; u in [0,1)^2.
  Vec2f sample(const Vec2f& u) const { return {sample_axis(u.x), sample_axis(u.y)}; }

 private:
  static constexpr int kIntervals = 256;
  float sample_axis(float u) const {
    const float x = u * kIntervals;
    const int i = std::min(int(x), kIntervals - 1);
    return inverse_cdf_[i] + (x - float(i)) * (inverse_cdf_[i + 1] - inverse_cdf_[i]);
  }
  std::array<float, kIntervals + 1> inverse_cdf_;
};

}  // namespace parian
