#include "materials/half_space.h"

#include <cmath>
#include <numbers>

#include "materials/fresnel.h"
#include "materials/quadrature.h"

namespace parian {
namespace {

constexpr int kNodes = 24;

/// Chandrasekhar's H for isotropic scattering: 1 / H(mu) = sqrt(1 - albedo) + albedo / 2 integral mu' H(mu')
/// / (mu + mu') dmu'.
class HFunction {
 public:
  HFunction(double albedo, const Quadrature& q) : albedo_(albedo), q_(q), h_(q.x.size(), 1.0) {
    constexpr int kMostSteps = 5000;
    std::vector<double> next(h_.size());
    double change = 1;
    for (int step = 0; step < kMostSteps && change > 1e-12; ++step) {
      change = 0;
      for (std::size_t i = 0; i < h_.size(); ++i) {
        next[i] = 0.5 * (h_[i] + (*this)(q_.x[i]));
        change = std::max(change, std::abs(next[i] - h_[i]));
      }
      h_ = next;
    }
  }

  double operator()(double mu) const {
    double sum = 0;
    for (std::size_t j = 0; j < h_.size(); ++j) sum += q_.weight[j] * q_.x[j] * h_[j] / (mu + q_.x[j]);
    return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * sum);
  }
  double at(std::size_t node) const { return h_[node]; }

 private:
  double albedo_;
  const Quadrature& q_;
  std::vector<double> h_;
};

}  // namespace

double fresnel_moment(double eta, int k) {
  return fresnel_quadrature(eta, 64).integrate(
      [&](double mu) { return fresnel_dielectric(float(mu), float(eta)) * std::pow(mu, k); });
}

double half_space_reflectance(double albedo, double eta) {
  if (albedo <= 0) return 0;
  if (albedo >= 1) return 1;
  const Quadrature q = fresnel_quadrature(1 / eta, kNodes);
  const HFunction h(albedo, q);
  const std::size_t n = q.x.size();
  std::vector<double> reflected(n), source(n);
  const double h0 = h(1);
  for (std::size_t i = 0; i < n; ++i) {
    reflected[i] = eta == 1 ? 0 : fresnel_dielectric(float(q.x[i]), float(1 / eta));
    source[i] = albedo * h.at(i) * h0 / (4 * (q.x[i] + 1)) / std::numbers::pi;
  }
  // Radiance below the interface, upwards: what comes from the beam, and what the interface has sent back.
  std::vector<double> up = source;
  double change = 1;
  while (change > 1e-10) {
    std::vector<double> next = source;
    change = 0;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j)
        next[i] += q.weight[j] * q.x[j] * albedo * h.at(i) * h.at(j) / (2 * (q.x[i] + q.x[j])) *
                   reflected[j] * up[j];
      change = std::max(change, std::abs(next[i] - up[i]));
    }
    up = next;
  }
  double out = 0;
  for (std::size_t i = 0; i < n; ++i) out += q.weight[i] * q.x[i] * (1 - reflected[i]) * up[i];
  return 2 * std::numbers::pi * out;
}

double half_space_albedo(double reflectance, double eta) {
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (half_space_reflectance(middle, eta) < reflectance ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace parian
