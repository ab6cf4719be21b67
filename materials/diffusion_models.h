/// The diffusion models themselves, in units of the reduced mean free path; for diffusion.cpp. `albedo` is
/// the reduced one, in [0, 1], and r > 0.
#pragma once

#include <cmath>
#include <numbers>

#include "renderer/base/quadrature.h"
#include "renderer/scene/fresnel.h"
#include "renderer/scene/half_space.h"

namespace parian {

/// Jensen, Marschner, Levoy and Hanrahan 2001: a source one mean free path deep, and its image above the
/// surface.
class ClassicalDipole {
 public:
  ClassicalDipole(double albedo, double eta) : albedo_(albedo), falloff_(std::sqrt(3 * (1 - albedo))) {
    const double reflected = 2 * fresnel_moment(1 / eta, 1);
    image_ = 1 + 4.0 / 3 * (1 + reflected) / (1 - reflected);
  }

  double operator()(double r) const {
    const auto source = [&](double z) {
      const double d = std::hypot(r, z);
      return z * (falloff_ + 1 / d) * std::exp(-falloff_ * d) / (d * d);
    };
    return albedo_ / (4 * std::numbers::pi) * (source(1) + source(image_));
  }
  double total() const { return albedo_ / 2 * (std::exp(-falloff_) + std::exp(-falloff_ * image_)); }

 private:
  double albedo_, falloff_;
  double image_;  // how far above the surface it is
};

/// What has been scattered more than once, of a source at any depth: with Grosjean's diffusion coefficient,
/// and leaving by fluence and by flux (d'Eon and Irving 2011, A Quantized-Diffusion Model for Rendering
/// Translucent Materials; d'Eon 2012).
class GrosjeanDipole {
 public:
  GrosjeanDipole(double albedo, double eta)
      : albedo_(albedo), diffusion_((2 - albedo) / 3), falloff_(std::sqrt((1 - albedo) / diffusion_)) {
    const double c1 = fresnel_moment(1 / eta, 1), c2 = fresnel_moment(1 / eta, 2);
    by_fluence_ = (1 - 2 * c1) / 4;
    by_flux_ = (1 - 3 * c2) / 2;
    shift_ = 4 * diffusion_ * (1 + 3 * c2) / (1 - 2 * c1);
  }

  double operator()(double r, double depth) const {
    const double height = depth + shift_, d = std::hypot(r, depth), v = std::hypot(r, height);
    const double real = std::exp(-falloff_ * d) / d, image = std::exp(-falloff_ * v) / v;
    const double fluence = (real - image) / diffusion_;
    const double flux = depth * (falloff_ + 1 / d) * real / d + height * (falloff_ + 1 / v) * image / v;
    return albedo_ * albedo_ / (4 * std::numbers::pi) * (by_fluence_ * fluence + by_flux_ * flux);
  }
  double total(double depth) const {
    const double real = std::exp(-falloff_ * depth), image = std::exp(-falloff_ * (depth + shift_));
    // (real - image) / falloff and its limit.
    const double difference = falloff_ > 0 ? real * -std::expm1(-falloff_ * shift_) / falloff_ : shift_;
    return albedo_ * albedo_ / 2 * (by_fluence_ * difference / diffusion_ + by_flux_ * (real + image));
  }

 private:
  double albedo_, diffusion_, falloff_, by_fluence_, by_flux_;
  double shift_;  // the image is that much farther above the surface than the source is below it
};

/// What has been scattered once, exactly (Habel, Christensen and Jarosz 2013, section 5), in a medium that
/// scatters isotropically. By the angle t to the normal at which it arrives below the surface, instead of the
/// depth r cot t: albedo / (4 pi r) integral of exp(-r cot(t / 2)) (1 - F(cos t)) cos t dt.
class SingleScattering {
 public:
  SingleScattering(double albedo, double eta) : albedo_(albedo) {
    const Quadrature unit = gauss_legendre(48);
    const double critical = std::asin(1 / eta);
    for (std::size_t i = 0; i < unit.x.size(); ++i) {
      // By the square, Fresnel's root at the critical angle becomes smooth.
      const double x = unit.x[i], t = critical * (1 - x * x);
      path_.push_back(1 / std::tan(t / 2));
      weight_.push_back(2 * critical * x * unit.weight[i] *
                        (1 - fresnel_dielectric_exact(std::cos(t), 1 / eta)) * std::cos(t));
    }
  }

  double operator()(double r) const {
    double sum = 0;
    for (std::size_t i = 0; i < path_.size(); ++i) sum += weight_[i] * std::exp(-r * path_[i]);
    return albedo_ / (4 * std::numbers::pi * r) * sum;
  }
  double total() const {
    double sum = 0;
    for (std::size_t i = 0; i < path_.size(); ++i) sum += weight_[i] / path_[i];
    return albedo_ / 2 * sum;
  }

 private:
  double albedo_;
  std::vector<double> path_;  // the path's length over r
  std::vector<double> weight_;
};

/// What has been scattered more than once, of sources all along the beam that goes in; less of it near the
/// surface, where diffusion gives too much (Habel, Christensen and Jarosz 2013, kappa).
class PhotonBeam {
 public:
  PhotonBeam(double albedo, double eta) : dipole_(albedo, eta) {
    // In the logarithm of the depth all is smooth and nought at both ends: even steps converge fast.
    constexpr double kFirst = -12, kLast = 3.5, kStep = 0.25;
    for (double x = kFirst; x < kLast; x += kStep) {
      depth_.push_back(std::exp(x));
      weight_.push_back(kStep * depth_.back() * std::exp(-depth_.back()));
    }
  }

  double operator()(double r) const {
    double sum = 0;
    for (std::size_t i = 0; i < depth_.size(); ++i) {
      const double kappa = -std::expm1(-2 * (std::hypot(r, depth_[i]) + depth_[i]));
      sum += weight_[i] * kappa * dipole_(r, depth_[i]);
    }
    return sum;
  }

 private:
  GrosjeanDipole dipole_;
  std::vector<double> depth_, weight_;
};

/// Christensen and Burley 2015: two exponentials, as wide as they fit light that goes in at a point at normal
/// incidence ("search light"); of the exact total.
class NormalizedDiffusion {
 public:
  NormalizedDiffusion(double albedo, double eta)
      : total_(half_space_reflectance(albedo, eta)),
        width_(1 / (1.85 - total_ + 7 * std::pow(std::abs(total_ - 0.8), 3))) {}

  double operator()(double r) const {
    return total_ * (std::exp(-r / width_) + std::exp(-r / (3 * width_))) /
           (8 * std::numbers::pi * width_ * r);
  }
  double total() const { return total_; }

 private:
  double total_, width_;
};

}  // namespace parian
