#include "materials/radial_profile.h"

#include <numbers>
#include <numeric>

namespace parian {
namespace {

/// The integral over the ring between radii a and b of what is linear in between.
double integrate_ring(double a, double b, double at_a, double at_b) {
  return std::numbers::pi / 3 * (b - a) * (at_a * (2 * a + b) + at_b * (a + 2 * b));
}

}  // namespace

RadialProfile::RadialProfile(const std::function<double(double)>& profile, double unit, double total) {
  if (!(total > 0)) return;
  std::vector<double> values;
  for (std::size_t i = 0; i <= cell_of(kLast); ++i) values.push_back(profile(node(i)));
  // Of the disk inside the first node, and of the ring from each to the next.
  std::vector<double> masses{std::numbers::pi * kFirst * kFirst * values[0]};
  for (std::size_t i = 0; i + 1 < values.size(); ++i)
    masses.push_back(integrate_ring(node(i), node(i + 1), values[i], values[i + 1]));
  // Beyond the last node, where only what does not absorb has anything left, profiles fall as r^-3.
  const double beyond = 2 * std::numbers::pi * kLast * kLast * values.back();
  const double all = std::accumulate(masses.begin(), masses.end(), beyond), scale = total / all;

  // As many cells as hold enough: never the disk alone, to which the first ring adds some percent.
  constexpr double kCut = 1e-4;
  std::size_t cells = 0;
  double mass = 0;
  while (cells < masses.size() && mass < (1 - kCut) * all) mass += masses[cells++];
  cells_ = Distribution1D(std::vector<float>(masses.begin(), masses.begin() + std::ptrdiff_t(cells)));
  for (std::size_t i = 0; i < cells; ++i) {
    const double a = inner_radius(i), b = node(i), area = std::numbers::pi * (b - a) * (b + a) * unit * unit;
    densities_.push_back(float(cells_.probability(int(i)) / area));
    values_.push_back(float(values[i] * scale / (unit * unit)));
  }
  unit_ = float(unit);
  inverse_unit_ = float(1 / unit);
  end_ = node(cells - 1);
  total_ = float(mass * scale);
}

float RadialProfile::sample(float u) const {
  if (total_ == 0) return 0;
  const Distribution1D::Sample cell = cells_.sample(u);
  const float a = inner_radius(std::size_t(cell.index)), b = node(std::size_t(cell.index));
  const float r = std::sqrt(a * a + cell.remainder * ((b - a) * (b + a)));
  return std::min(r, std::nextafter(end_, 0.0f)) * unit_;
}

}  // namespace parian
