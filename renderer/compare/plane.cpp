#include "renderer/compare/plane.h"

#include <algorithm>
#include <numeric>

#include "renderer/base/parallel.h"

namespace parian {
namespace {

// sum += weight * values, for all of a row: the inner loop of both filters, which the compiler makes vectors
// of.
void add_scaled(float* sum, const float* values, float weight, int count) {
  for (int x = 0; x < count; ++x) sum[x] += weight * values[x];
}

}  // namespace

Plane filter_rows(const Plane& plane, const Kernel& kernel) {
  const int radius = int(kernel.size()) / 2, width = plane.width;
  Plane result(width, plane.height);
  parallel_for(std::size_t(plane.height), 8, [&](std::size_t y) {
    const float* row = plane.row(int(y));
    std::vector<float> padded(std::size_t(width + 2 * radius), row[0]);
    std::copy_n(row, width, padded.begin() + radius);
    std::fill(padded.begin() + radius + width, padded.end(), row[width - 1]);
    for (int k = 0; k <= 2 * radius; ++k)
      add_scaled(result.row(int(y)), padded.data() + k, kernel[std::size_t(2 * radius - k)], width);
  });
  return result;
}

Plane filter_columns(const Plane& plane, const Kernel& kernel) {
  const int radius = int(kernel.size()) / 2;
  Plane result(plane.width, plane.height);
  parallel_for(std::size_t(plane.height), 8, [&](std::size_t y) {
    for (int k = 0; k <= 2 * radius; ++k) {
      const int from = std::clamp(int(y) + k - radius, 0, plane.height - 1);
      add_scaled(result.row(int(y)), plane.row(from), kernel[std::size_t(2 * radius - k)], plane.width);
    }
  });
  return result;
}

double mean(const Plane& plane) {
  return std::accumulate(plane.values.begin(), plane.values.end(), 0.0) / double(plane.values.size());
}

}  // namespace parian
