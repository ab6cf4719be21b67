#include "materials/diffusion.h"

#include <algorithm>

#include "materials/diffusion_models.h"

namespace parian {
namespace {

constexpr double kNearest = 1e-6;

/// As a function of r >= 0: some of them have a pole at 0.
template <class Model>
std::function<double(double)> from_nearest(const Model& model) {
  return [model](double r) { return model(std::max(r, kNearest)); };
}

/// The integral over the plane of what is smooth in the logarithm of r.
template <class Model>
double integrate_plane(const Model& model) {
  constexpr double kFirst = -12, kLast = 14, kStep = 0.125;
  double sum = 0;
  for (double x = kFirst; x < kLast; x += kStep) sum += std::exp(2 * x) * model(std::exp(x));
  return 2 * std::numbers::pi * kStep * sum;
}

}  // namespace

std::function<double(double)> make_diffusion(Diffusion model, double albedo, double eta) {
  if (model == Diffusion::dipole) return from_nearest(ClassicalDipole(albedo, eta));
  if (model == Diffusion::burley) return from_nearest(NormalizedDiffusion(albedo, eta));
  const SingleScattering once(albedo, eta);
  if (model == Diffusion::better_dipole)
    return from_nearest(
        [dipole = GrosjeanDipole(albedo, eta), once](double r) { return dipole(r, 1) + once(r); });
  return from_nearest([beam = PhotonBeam(albedo, eta), once](double r) { return beam(r) + once(r); });
}

double diffusion_reflectance(Diffusion model, double albedo, double eta) {
  if (model == Diffusion::dipole) return ClassicalDipole(albedo, eta).total();
  if (model == Diffusion::burley) return NormalizedDiffusion(albedo, eta).total();
  const double once = SingleScattering(albedo, eta).total();
  if (model == Diffusion::better_dipole) return GrosjeanDipole(albedo, eta).total(1) + once;
  return integrate_plane(PhotonBeam(albedo, eta)) + once;
}

RadialProfile make_profile(Diffusion model, float absorption, float reduced_scattering, float eta,
                           std::optional<double> total) {
  if (!(reduced_scattering > 0)) return {};
  const double extinction = double(absorption) + reduced_scattering, albedo = reduced_scattering / extinction;
  return {make_diffusion(model, albedo, eta), 1 / extinction,
          total ? *total : diffusion_reflectance(model, albedo, eta)};
}

}  // namespace parian
