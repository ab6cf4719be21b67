/// Pearson's chi-square test of samplers against the densities that they claim.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/math.h"

namespace parian {

/// Q(a, x): the regularised upper incomplete gamma function, by its series or its continued fraction
/// (Abramowitz and Stegun 6.5.29, 6.5.31). a > 0, x >= 0.
inline double gamma_q(double a, double x) {
  if (x <= 0) return 1;
  const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term > sum * 1e-15; ++n) sum += term *= x / (a + n);
    return 1 - front * sum;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;  // modified Lentz
  for (int n = 1; n < 10000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return front * h;
}

/// Whether counts are as expected, at a significance of 1% over `tests` tests (Sidak). Cells that expect
/// fewer than 5 are pooled; samples where none is expected fail, but for one in 5000 that quadrature may not
/// see at a border. The sums of both must agree: a sampler that fails at times has a cell for its failures.
inline testing::AssertionResult chi_square(std::span<const double> observed, std::span<const double> expected,
                                           int tests = 1) {
  const double samples = std::accumulate(observed.begin(), observed.end(), 0.0);
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  if (!(std::abs(total - samples) < 2e-3 * samples))
    return testing::AssertionFailure()
           << "the density integrates to " << total / samples << " over all cells";
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::ranges::sort(order, {}, [&](std::size_t i) { return expected[i]; });
  double statistic = 0, pooled_observed = 0, pooled_expected = 0, stray = 0;
  int cells = 0;
  for (const std::size_t i : order) {
    if (expected[i] == 0) stray += observed[i];
    pooled_observed += observed[i];
    pooled_expected += expected[i];
    if (pooled_expected < 5) continue;
    statistic += (pooled_observed - pooled_expected) * (pooled_observed - pooled_expected) / pooled_expected;
    pooled_observed = pooled_expected = 0;
    ++cells;
  }
  if (stray > 2e-4 * samples)
    return testing::AssertionFailure() << stray << " samples in cells of density zero";
  if (cells < 2) return testing::AssertionSuccess() << "one cell";
  const double p = gamma_q(0.5 * (cells - 1), 0.5 * statistic), least = 1 - std::pow(0.99, 1.0 / tests);
  if (p >= least) return testing::AssertionSuccess() << "p = " << p;
  return testing::AssertionFailure() << "chi-square " << statistic << " with " << cells - 1
                                     << " degrees of freedom: p = " << p << " < " << least;
}

/// Integral of f over [x0, x1] x [y0, y1]: Gauss-Legendre of 4 x 4 points, the rectangle cut into four, three
/// times at least and `depth` times at most, until the parts agree with the whole to `tolerance` and none of
/// them has the border of where f is 0 in it.
template <class F>
double integrate(const F& f, double x0, double x1, double y0, double y1, double tolerance = 1e-7,
                 int depth = 8) {
  struct Piece {
    double sum;
    bool border;
  };
  const auto gauss = [&](double ax, double bx, double ay, double by) {
    constexpr std::array<double, 4> node{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                         0.8611363115940526};
    constexpr std::array<double, 4> weight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                           0.3478548451374538};
    double sum = 0;
    int zeros = 0;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const double value = f(0.5 * (ax + bx + node[i] * (bx - ax)), 0.5 * (ay + by + node[j] * (by - ay)));
        sum += weight[i] * weight[j] * value;
        zeros += value == 0;
      }
    return Piece{sum * 0.25 * (bx - ax) * (by - ay), zeros > 0 && zeros < 16};
  };
  const auto refine = [&](const auto& self, double ax, double bx, double ay, double by, double whole,
                          int level) -> double {
    const double mx = 0.5 * (ax + bx), my = 0.5 * (ay + by);
    const Piece parts[4] = {gauss(ax, mx, ay, my), gauss(mx, bx, ay, my), gauss(ax, mx, my, by),
                            gauss(mx, bx, my, by)};
    double sum = 0;
    bool border = false;
    for (const Piece& part : parts) {
      sum += part.sum;
      border = border || part.border;
    }
    if (level >= depth || (level >= 3 && !border && std::abs(sum - whole) < tolerance)) return sum;
    return self(self, ax, mx, ay, my, parts[0].sum, level + 1) +
           self(self, mx, bx, ay, my, parts[1].sum, level + 1) +
           self(self, ax, mx, my, by, parts[2].sum, level + 1) +
           self(self, mx, bx, my, by, parts[3].sum, level + 1);
  };
  return refine(refine, x0, x1, y0, y1, gauss(x0, x1, y0, y1).sum, 1);
}

/// The sphere cut into rings around an axis and sectors of a ring. Rings are of
/// equal solid angle while s = 1 - cos(angle to the axis) is below `zoom`, and grow in proportion to s
/// beyond.
struct SphereCells {
  Vec3f axis{0, 0, 1};
  double zoom = 100;
  int rings = 20, sectors = 20;
  double tolerance = 1e-7;  // of the integral over a cell
  int depth = 8;            // how often integrate() halves it

  int count() const { return rings * sectors; }
  int find(const Vec3f& w) const {
    // 1 - cos from the chord, which does not cancel.
    const Frame frame = make_frame(axis);
    const double s = 0.5 * (Vec3d(w) - Vec3d(axis)).length2();
    const double phi = std::atan2(double(w.dot(frame.y)), double(w.dot(frame.x))) / (2 * std::numbers::pi);
    const int ring = std::clamp(int(std::log1p(s / zoom) / std::log1p(2 / zoom) * rings), 0, rings - 1);
    return ring * sectors + std::clamp(int((phi < 0 ? phi + 1 : phi) * sectors), 0, sectors - 1);
  }
  /// Integral over cell i of a function of the unit direction, per solid angle.
  template <class F>
  double integral(int i, const F& f) const {
    const Frame frame = make_frame(axis);
    const double growth = std::log1p(2 / zoom);
    const auto in_square = [&](double u, double v) {
      const double s = zoom * std::expm1(growth * u), ds = growth * (s + zoom);
      const double r = std::sqrt(std::max(0.0, s * (2 - s))), phi = 2 * std::numbers::pi * v;
      const Vec3d w = Vec3d(frame.x) * (r * std::cos(phi)) + Vec3d(frame.y) * (r * std::sin(phi)) +
                      Vec3d(frame.z) * (1 - s);
      return double(f(Vec3f(w))) * ds * 2 * std::numbers::pi;
    };
    const int ring = i / sectors, sector = i % sectors;
    return integrate(in_square, double(ring) / rings, double(ring + 1) / rings, double(sector) / sectors,
                     double(sector + 1) / sectors, tolerance, depth);
  }
  template <class F>
  double integral(const F& f) const {
    double sum = 0;
    for (int i = 0; i < count(); ++i) sum += integral(i, f);
    return sum;
  }
};

/// Whether sample() -> std::optional<Vec3f> draws unit directions with the density pdf(w) per solid angle,
/// which must integrate to `total`, the probability that it succeeds; where `total` is not given, to whatever
/// share succeeds.
template <class Sample, class Pdf>
testing::AssertionResult samples_directions(const Sample& sample, const Pdf& pdf, const SphereCells& cells,
                                            int samples, int tests, std::optional<double> total = {}) {
  std::vector<double> observed(cells.count() + 1, 0), expected(cells.count() + 1, 0);
  for (int i = 0; i < samples; ++i) {
    const std::optional<Vec3f> w = sample();
    ++observed[w ? cells.find(*w) : cells.count()];
  }
  double sum = 0;
  for (int i = 0; i < cells.count(); ++i) sum += expected[i] = cells.integral(i, pdf);
  if (!(sum < 1 + 1e-3)) return testing::AssertionFailure() << "the density integrates to " << sum;
  if (total && !(std::abs(sum - *total) < 1e-3))
    return testing::AssertionFailure() << "the density integrates to " << sum << ", not " << *total;
  expected.back() = std::max(0.0, 1 - sum);
  // A density of 1 within the error of quadrature leaves no cell for failures.
  if (expected.back() < 1e-3 && observed.back() == 0) expected.back() = 0;
  for (double& e : expected) e *= samples;
  return chi_square(observed, expected, tests);
}

}  // namespace parian
