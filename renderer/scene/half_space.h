/// What a thick flat body gives back, exactly: no diffusion.
#pragma once

namespace parian {

/// The share of light that comes out again of a half-space into which it went at normal incidence, and of
/// which it has just passed the interface: smooth, of index eta >= 1 against what is outside. The half-space
/// scatters isotropically with single-scattering albedo `albedo` in [0, 1]. To 1e-6.
///
/// Without interface, a half-space reflects from mu0 to mu as albedo H(mu) H(mu0) / (4 (mu + mu0)), H being
/// Chandrasekhar's function (Radiative Transfer, 1950, chapter V); the interface sends what it reflects back
/// in at the same angle.
double half_space_reflectance(double albedo, double eta);

/// The share of diffuse light that comes out again of such a half-space below a diffuse interface: one that
/// sends what it lets through in all directions alike, as KHR_materials_diffuse_transmission has it, and
/// reflects the share `reflected` of diffuse light on both sides. Of the light that has got in.
double diffuse_half_space_reflectance(double albedo, double reflected);

/// The albedo in [0, 1] for which half_space_reflectance() is `reflectance`, which is clamped to [0, 1].
/// To 1e-6.
double half_space_albedo(double reflectance, double eta);

}  // namespace parian
