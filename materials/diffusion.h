/// Models of the diffusion of light in a half-space: R_d(r), the share per area of the light that went in at
/// a point of a plane, at normal incidence and past the interface, that comes out at distance r.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "materials/radial_profile.h"

namespace parian {

enum class Diffusion : std::uint8_t {
  dipole,         // Jensen, Marschner, Levoy, Hanrahan 2001, A Practical Model for Subsurface Light Transport
  better_dipole,  // d'Eon 2012, A Better Dipole, with single scattering apart
  burley,         // Christensen and Burley 2015, Approximate Reflectance Profiles for Efficient Subsurface
                  // Scattering
  photon_beam     // Habel, Christensen, Jarosz 2013, Photon Beam Diffusion
};

/// R_d as a function of r >= 0, in units of the reduced mean free path 1 / sigma_t': of a medium of reduced
/// albedo sigma_s' / sigma_t' in [0, 1] below a smooth interface of index eta >= 1. Moments of Fresnel's
/// reflectance are exact, not the papers' fits. What has a pole at 0 is cut off at a millionth.
std::function<double(double)> make_diffusion(Diffusion model, double albedo, double eta);

/// The integral of R_d over the plane.
double diffusion_reflectance(Diffusion model, double albedo, double eta);

/// The profile of one channel; coefficients per metre; black where nothing scatters. `total`: what its
/// integral is made to be, in place of the model's own, which misses what such a half-space really gives back
/// (half_space_reflectance()) by some percent.
RadialProfile make_profile(Diffusion model, float absorption, float reduced_scattering, float eta,
                           std::optional<double> total = {});

}  // namespace parian
