/// Models of the diffusion of light in a half-space: R_d(r), the share per area of what went in at a point,
/// at normal incidence, that comes out at distance r.
#pragma once

#include <functional>

#include "materials/radial_profile.h"

namespace parian {

enum class Diffusion : std::uint8_t {
  dipole,         // Jensen, Marschner, Levoy, Hanrahan 2001, A Practical Model for Subsurface Light Transport
  better_dipole,  // d'Eon 2012, A Better Dipole, with single scattering apart
  burley,         // Christensen and Burley 2015, Approximate Reflectance Profiles for Efficient Subsurface
                  // Scattering
  photon_beam     // Habel, Christensen, Jarosz 2013, Photon Beam Diffusion
};

/// R_d(r) in units of the reduced mean free path, for r > 0: of a medium with reduced albedo sigma_s' /
/// sigma_t' in [0, 1] below a smooth interface of index eta >= 1. The internal reflectance is Fresnel's
/// integral itself.
std::function<double(double)> make_diffusion(Diffusion model, double albedo, double eta);

/// The integral of R_d over the plane.
double diffusion_reflectance(Diffusion model, double albedo, double eta);

/// The profile of one channel; coefficients per metre, of which one at least is not 0. `scaled`: to what such
/// a half-space really gives back (half_space_reflectance()), which the models miss by some percent.
RadialProfile make_profile(Diffusion model, double absorption, double reduced_scattering, double eta,
                           bool scaled);

}  // namespace parian
