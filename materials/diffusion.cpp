#include "materials/diffusion.h"

#include <cmath>
#include <numbers>

#include "materials/fresnel.h"
#include "materials/half_space.h"
#include "materials/quadrature.h"

namespace parian {
namespace {

// Everything here is in units of the reduced mean free path.

constexpr double kPi64 = std::numbers::pi;

/// Internal reflectance of diffuse light at the boundary.
double internal_reflectance(double eta) { return 2 * fresnel_moment(1 / eta, 1); }

/// The classical dipole: a real source one mean free path deep, and a virtual one above the surface.
struct ClassicalDipole {
  double albedo, falloff, real = 1, virtual_;

  ClassicalDipole(double a, double eta) : albedo(a), falloff(std::sqrt(3 * (1 - a))) {
    const double f = internal_reflectance(eta);
    virtual_ = 1 + 4.0 / 3 * (1 + f) / (1 - f);
  }
  double operator()(double r) const {
    const auto term = [&](double z) {
      const double d = std::hypot(r, z);
      return z * (falloff + 1 / d) * std::exp(-falloff * d) / (d * d);
    };
    return albedo / (4 * kPi64) * (term(real) + term(virtual_));
  }
  double total() const { return albedo / 2 * (std::exp(-falloff * real) + std::exp(-falloff * virtual_)); }
};

/// The dipole with Grosjean's diffusion coefficient and what leaves by both the fluence and the flux (d'Eon
/// and Irving 2011, A Quantized-Diffusion Model for Rendering Translucent Materials): what has been scattered
/// more than once, by a source at any depth.
struct GrosjeanDipole {
  double albedo, diffusion, falloff, c_fluence, c_flux,
      image;  // image: how much farther up the virtual source is

  GrosjeanDipole(double a, double eta)
      : albedo(a), diffusion((2 - a) / 3), falloff(std::sqrt((1 - a) / diffusion)) {
    const double c1 = fresnel_moment(1 / eta, 1), c2 = fresnel_moment(1 / eta, 2);
    c_fluence = (1 - 2 * c1) / 4;
    c_flux = (1 - 3 * c2) / 2;
    image = 4 * diffusion * (1 + 3 * c2) / (1 - 2 * c1);
  }
  double operator()(double r, double depth) const {
    const double above = depth + image, d = std::hypot(r, depth), v = std::hypot(r, above);
    const double e_d = std::exp(-falloff * d) / d, e_v = std::exp(-falloff * v) / v;
    const double fluence = (e_d - e_v) / diffusion;
    const double flux = depth * (falloff + 1 / d) * e_d / d + above * (falloff + 1 / v) * e_v / v;
    return albedo * albedo / (4 * kPi64) * (c_fluence * fluence + c_flux * flux);
  }
  double total(double depth) const {
    const double e_d = std::exp(-falloff * depth), e_v = std::exp(-falloff * (depth + image));
    // (e_d - e_v) / falloff, which has a limit.
    const double difference = falloff > 0 ? e_d * -std::expm1(-falloff * image) / falloff : image;
    return albedo * albedo / 2 * (c_fluence * difference / diffusion + c_flux * (e_d + e_v));
  }
};

/// Light scattered once, exactly: by the angle t below which the place of the scattering is seen, in a medium
/// that scatters isotropically, albedo / (4 pi r) integral exp(-r cot(t / 2)) (1 - F(cos t)) cos t dt.
class SingleScattering {
 public:
  SingleScattering(double albedo, double eta) : albedo_(albedo) {
    const Quadrature unit = gauss_legendre(48);
    const double critical = std::asin(1 / eta);
    for (std::size_t i = 0; i < unit.x.size(); ++i) {
      // By the square Fresnel's root at the critical angle becomes smooth.
      const double x = unit.x[i], t = critical * (1 - x * x);
      const double f = fresnel_dielectric(float(std::cos(t)), float(1 / eta));
      slopes_.push_back(1 / std::tan(t / 2));
      weights_.push_back(critical * 2 * x * unit.weight[i] * (1 - f) * std::cos(t));
    }
  }
  double operator()(double r) const {
    double sum = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) sum += weights_[i] * std::exp(-r * slopes_[i]);
    return albedo_ / (4 * kPi64 * r) * sum;
  }
  double total() const {
    double sum = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) sum += weights_[i] / slopes_[i];
    return albedo_ / 2 * sum;
  }

 private:
  double albedo_;
  std::vector<double> slopes_, weights_;
};

/// The dipole's sources all along the beam that goes in, less near the surface, where diffusion gives too
/// much (Habel et al., eq. 14).
class PhotonBeam {
 public:
  PhotonBeam(double albedo, double eta) : dipole_(albedo, eta) {
    // Even in the logarithm of the depth, where everything is smooth.
    constexpr double kStep = 0.125;
    for (double x = -14; x < 4; x += kStep) {
      const double depth = std::exp(x);
      depths_.push_back(depth);
      weights_.push_back(kStep * depth * std::exp(-depth));
    }
  }
  double operator()(double r) const {
    double sum = 0;
    for (std::size_t i = 0; i < depths_.size(); ++i) {
      const double correction = -std::expm1(-2 * (std::hypot(r, depths_[i]) + depths_[i]));
      sum += weights_[i] * correction * dipole_(r, depths_[i]);
    }
    return sum;
  }

 private:
  GrosjeanDipole dipole_;
  std::vector<double> depths_, weights_;
};

/// Normalised diffusion: two exponentials, as wide as the total says for light that goes in at a point
/// ("search light").
struct Burley {
  double total, width;

  Burley(double albedo, double eta) : total(half_space_reflectance(albedo, eta)) {
    width = 1 / (1.85 - total + 7 * std::pow(std::abs(total - 0.8), 3));
  }
  double operator()(double r) const {
    return total * (std::exp(-r / width) + std::exp(-r / (3 * width))) / (8 * kPi64 * width * r);
  }
};

/// Integral over the plane of what is smooth in the logarithm of r.
double integrate_plane(const std::function<double(double)>& profile) {
  constexpr double kStep = 0.05;
  double sum = 0;
  for (double x = -12; x < 12; x += kStep) sum += kStep * 2 * kPi64 * std::exp(2 * x) * profile(std::exp(x));
  return sum;
}

}  // namespace

std::function<double(double)> make_diffusion(Diffusion model, double albedo, double eta) {
  switch (model) {
    case Diffusion::dipole:
      return ClassicalDipole(albedo, eta);
    case Diffusion::burley:
      return Burley(albedo, eta);
    case Diffusion::better_dipole:
      return [dipole = GrosjeanDipole(albedo, eta), once = SingleScattering(albedo, eta)](double r) {
        return dipole(r, 1) + once(r);
      };
    case Diffusion::photon_beam:
      break;
  }
  return [beam = PhotonBeam(albedo, eta), once = SingleScattering(albedo, eta)](double r) {
    return beam(r) + once(r);
  };
}

double diffusion_reflectance(Diffusion model, double albedo, double eta) {
  switch (model) {
    case Diffusion::dipole:
      return ClassicalDipole(albedo, eta).total();
    case Diffusion::burley:
      return Burley(albedo, eta).total;
    case Diffusion::better_dipole:
      return GrosjeanDipole(albedo, eta).total(1) + SingleScattering(albedo, eta).total();
    case Diffusion::photon_beam:
      break;
  }
  return integrate_plane(PhotonBeam(albedo, eta)) + SingleScattering(albedo, eta).total();
}

RadialProfile make_profile(Diffusion model, double absorption, double reduced_scattering, double eta,
                           bool scaled) {
  const double extinction = absorption + reduced_scattering, albedo = reduced_scattering / extinction;
  return {make_diffusion(model, albedo, eta), 1 / extinction,
          scaled ? half_space_reflectance(albedo, eta) : diffusion_reflectance(model, albedo, eta)};
}

}  // namespace parian
