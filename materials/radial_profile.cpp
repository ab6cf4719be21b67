#include "materials/radial_profile.h"

#include <numbers>

namespace parian {

RadialProfile::RadialProfile(const std::function<double(double)>& profile, double unit, double total)
    : unit_(float(unit)), inverse_unit_(float(1 / unit)) {
  if (!(total > 0)) return;
  constexpr double kCut = 1e-4, kPi2 = 2 * std::numbers::pi;
  const std::size_t nodes = ((std::bit_cast<std::uint32_t>(kLast) - kFirstBits) >> kShift) + 1;
  std::vector<double> values;
  for (std::size_t i = 0; i < nodes; ++i) values.push_back(profile(node(i)));

  // What each cell holds of the table: a disk, and rings.
  std::vector<double> masses{values[0] * kPi2 / 2 * kFirst * kFirst};
  double all = masses[0];
  for (std::size_t i = 0; i + 1 < nodes; ++i) {
    const double a = node(i), b = node(i + 1), slope = (values[i + 1] - values[i]) / (b - a);
    masses.push_back(kPi2 *
                     ((values[i] - slope * a) * (b * b - a * a) / 2 + slope * (b * b * b - a * a * a) / 3));
    all += masses.back();
  }
  // Beyond the table, where nothing absorbs, profiles fall as r^-3.
  const double beyond = kPi2 * values.back() * kLast * kLast, scale = total / (all + beyond);
  std::size_t end = 0;
  for (double sum = 0; end < masses.size() && sum < (1 - kCut) * (all + beyond); ++end) sum += masses[end];
  end_ = node(end - 1);

  std::vector<float> weights;
  double kept = 0;
  for (std::size_t i = 0; i < end; ++i) {
    weights.push_back(float(masses[i]));
    kept += masses[i];
  }
  cells_ = Distribution1D(weights);
  total_ = float(kept * scale);
  for (std::size_t i = 0; i < end; ++i) {
    const double a = i == 0 ? 0 : node(i - 1), b = node(i);
    densities_.push_back(float(cells_.probability(int(i)) / (kPi2 / 2 * (b * b - a * a) * unit * unit)));
    values_.push_back(float(values[i] * scale / (unit * unit)));
  }
}

float RadialProfile::sample(float u) const {
  const Distribution1D::Sample cell = cells_.sample(u);
  const float a = cell.index == 0 ? 0 : node(std::size_t(cell.index) - 1), b = node(std::size_t(cell.index));
  const float r = std::sqrt(a * a + cell.remainder * (b * b - a * a));
  return std::min(r, std::nextafter(end_, 0.0f)) * unit_;
}

}  // namespace parian
