#include "renderer/base/quadrature.h"

#include <cmath>
#include <numbers>

namespace parian {

Quadrature gauss_legendre(int n) {
  Quadrature q;
  for (int i = 0; i < n; ++i) {
    // Newton's method on Legendre's polynomial, from near its i-th root.
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0;
    for (int step = 0; step < 100; ++step) {
      double p = 1, before = 0;
      for (int k = 1; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (x * p - before) / (x * x - 1);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    q.x.push_back((1 - x) / 2);
    q.weight.push_back(1 / ((1 - x * x) * slope * slope));
  }
  return q;
}

Quadrature fresnel_quadrature(double eta, int n) {
  const Quadrature unit = gauss_legendre(n);
  if (eta >= 1) return unit;
  const double critical = std::sqrt(1 - eta * eta);
  Quadrature q;
  for (std::size_t i = 0; i < unit.x.size(); ++i) {
    q.x.push_back(critical * unit.x[i]);
    q.weight.push_back(critical * unit.weight[i]);
  }
  // By the square of the variable the square root becomes smooth.
  for (std::size_t i = 0; i < unit.x.size(); ++i) {
    q.x.push_back(critical + (1 - critical) * unit.x[i] * unit.x[i]);
    q.weight.push_back((1 - critical) * 2 * unit.x[i] * unit.weight[i]);
  }
  return q;
}

}  // namespace parian
