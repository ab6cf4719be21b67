/// One number for each pixel, and filters over them.
#pragma once

#include <cstddef>
#include <vector>

namespace parian {

/// Row-major from the top left.
struct Plane {
  int width = 0, height = 0;
  std::vector<float> values;

  Plane() = default;
  Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * h) {}
  float* row(int y) { return values.data() + std::size_t(y) * width; }
  const float* row(int y) const { return values.data() + std::size_t(y) * width; }
};

/// Red, green and blue, linear Rec.709, of equal size.
struct RgbPlanes {
  Plane r, g, b;
};

/// An odd number of weights, the middle one for the pixel itself.
using Kernel = std::vector<float>;

/// Convolves each row, or each column, in parallel; beyond the border its last pixel goes on.
Plane filter_rows(const Plane& plane, const Kernel& kernel);
Plane filter_columns(const Plane& plane, const Kernel& kernel);

/// The mean, added up in double precision.
double mean(const Plane& plane);

}  // namespace parian
