#include "renderer/scene/half_space.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/quadrature.h"
#include "renderer/scene/fresnel.h"

namespace parian {
namespace {

constexpr int kNodes = 24;

/// Chandrasekhar's H for isotropic scattering: 1 / H(mu) = sqrt(1 - albedo) + albedo / 2 integral mu' H(mu')
/// / (mu + mu') dmu', the form that is stable for an albedo of 1 too.
class HFunction {
 public:
  HFunction(double albedo, const Quadrature& q) : albedo_(albedo), q_(q), h_(q.x.size(), 1.0) {
    constexpr int kMostSteps = 1000;
    std::vector<double> next(h_.size());
    double change = 1;
    for (int step = 0; step < kMostSteps && change > 1e-13; ++step) {
      change = 0;
      for (std::size_t i = 0; i < h_.size(); ++i) {
        // Twice too large an H makes the right side half as large: the mean of both is close.
        next[i] = 0.5 * (h_[i] + (*this)(q_.x[i]));
        change = std::max(change, std::abs(next[i] - h_[i]));
      }
      h_.swap(next);
    }
  }

  double operator()(double mu) const {
    double sum = 0;
    for (std::size_t j = 0; j < h_.size(); ++j) sum += q_.weight[j] * q_.x[j] * h_[j] / (mu + q_.x[j]);
    return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * sum);
  }
  double at_node(std::size_t i) const { return h_[i]; }

 private:
  double albedo_;
  const Quadrature& q_;
  std::vector<double> h_;
};

/// Solves matrix x = right, the rows one after the other, by Gaussian elimination. Without pivots: the matrix
/// is 1 less a positive one whose powers vanish.
std::vector<double> solve(std::vector<double> matrix, std::vector<double> right) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k)
    for (std::size_t i = k + 1; i < n; ++i) {
      const double factor = matrix[i * n + k] / matrix[k * n + k];
      for (std::size_t j = k; j < n; ++j) matrix[i * n + j] -= factor * matrix[k * n + j];
      right[i] -= factor * right[k];
    }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t j = i + 1; j < n; ++j) right[i] -= matrix[i * n + j] * right[j];
    right[i] /= matrix[i * n + i];
  }
  return right;
}

}  // namespace

double half_space_reflectance(double albedo, double eta) {
  if (albedo <= 0) return 0;
  if (albedo >= 1) return 1;
  const Quadrature q = fresnel_quadrature(1 / eta, kNodes);
  const HFunction h(albedo, q);
  const std::size_t n = q.x.size();
  const double h_beam = h(1);
  std::vector<double> reflected(n), from_beam(n), matrix(n * n);
  for (std::size_t j = 0; j < n; ++j) reflected[j] = fresnel_dielectric_exact(q.x[j], 1 / eta);
  // Radiance below the interface, upwards, times pi for a beam of power 1: what the half-space makes of the
  // beam and of what the interface sends back.
  for (std::size_t i = 0; i < n; ++i) {
    from_beam[i] = albedo * h.at_node(i) * h_beam / (4 * (q.x[i] + 1));
    for (std::size_t j = 0; j < n; ++j)
      matrix[i * n + j] = double(i == j) - q.weight[j] * q.x[j] * reflected[j] * albedo * h.at_node(i) *
                                               h.at_node(j) / (2 * (q.x[i] + q.x[j]));
  }
  const std::vector<double> up = solve(std::move(matrix), std::move(from_beam));
  double out = 0;
  for (std::size_t i = 0; i < n; ++i) out += 2 * q.weight[i] * q.x[i] * (1 - reflected[i]) * up[i];
  return out;
}

double diffuse_half_space_reflectance(double albedo, double reflected) {
  if (albedo <= 0) return 0;
  const Quadrature q = gauss_legendre(kNodes);
  const HFunction h(albedo, q);
  // By the integral of H's equation, 1 - 2 sqrt(1 - albedo) integral H(mu) mu dmu.
  double moment = 0;
  for (std::size_t i = 0; i < q.x.size(); ++i) moment += q.weight[i] * q.x[i] * h.at_node(i);
  const double up = 1 - 2 * std::sqrt(1 - albedo) * moment;
  return up * (1 - reflected) / (1 - up * reflected);
}

double half_space_albedo(double reflectance, double eta) {
  if (reflectance <= 0) return 0;
  if (reflectance >= 1) return 1;
  double low = 0, high = 1;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (half_space_reflectance(middle, eta) < reflectance ? low : high) = middle;
  }
  return (low + high) / 2;
}

}  // namespace parian
