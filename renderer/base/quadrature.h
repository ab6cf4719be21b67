/// Gauss-Legendre quadrature, for what is computed once and not for each ray.
#pragma once

#include <vector>

namespace parian {

/// Nodes and weights: the integral of f is about the sum of weight f(x).
struct Quadrature {
  std::vector<double> x, weight;

  template <class F>
  double integrate(const F& f) const {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += weight[i] * f(x[i]);
    return sum;
  }
};

/// On [0, 1], with n nodes: exact for polynomials of degree 2 n - 1.
Quadrature gauss_legendre(int n);

/// On [0, 1] for functions of a cosine that have the singularity of Fresnel's reflectance, a square root, at
/// the critical angle of an interface to a medium of relative index eta, where that is below 1.
Quadrature fresnel_quadrature(double eta, int n);

}  // namespace parian
