/// What a thick flat body gives back, exactly: no diffusion.
#pragma once

namespace parian {

/// The share of light that comes out again of a half-space into which it went at normal incidence, and of
/// which it has just passed the interface: smooth, of index eta >= 1 against what is outside. The half-space
/// scatters isotropically with single-scattering albedo `albedo` in [0, 1].
///
/// Without interface, a half-space reflects from mu0 to mu as albedo H(mu) H(mu0) / (4 (mu + mu0)), H being
/// Chandrasekhar's function (Radiative Transfer, 1950, chapter V); the interface sends what it reflects back
/// in at the same angle. To 1e-6.
double half_space_reflectance(double albedo, double eta);

/// The albedo for which half_space_reflectance() is `reflectance`, in [0, 1].
double half_space_albedo(double reflectance, double eta);

/// The integral of F(mu) mu^k dmu over mu from 0 to 1, F being Fresnel's reflectance of an interface to a
/// medium of relative index eta, below 1 from inside. To 1e-9.
double fresnel_moment(double eta, int k);

}  // namespace parian
