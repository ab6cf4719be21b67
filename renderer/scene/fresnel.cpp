#include "renderer/scene/fresnel.h"

#include "renderer/base/quadrature.h"

namespace parian {

double fresnel_dielectric_exact(double cosine, double eta) {
  const double q2 = (eta - 1) * (eta + 1) + cosine * cosine;
  if (q2 <= 0) return 1;
  const double q = std::sqrt(q2), p = eta * eta * cosine;
  const double r_s = (cosine - q) / (cosine + q), r_p = (p - q) / (p + q);
  return 0.5 * (r_s * r_s + r_p * r_p);
}

double fresnel_moment(double eta, int k) {
  return fresnel_quadrature(eta, 64).integrate(
      [&](double mu) { return fresnel_dielectric_exact(mu, eta) * std::pow(mu, k); });
}

}  // namespace parian
