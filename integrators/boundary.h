/// Where a path meets the surface of a medium.
#pragma once

#include "renderer/session/integrator.h"

namespace parian {

/// What lies on both sides of a surface that a path has come to, null where that is vacuum, and what the path
/// is in once it has gone through.
struct Boundary {
  const Medium *before = nullptr, *after = nullptr;
  MediumStack beyond;
};

/// Finds the boundary at `surface`, which the path met at `hit` and whose part bounds a medium, and all that
/// lie in the same place within rounding, as where water touches its glass: they are one boundary, between
/// what is before all of them and what is behind all of them. (One after the other they would be two with a
/// gap of air between; and a ray that leaves the one would already be past the other.) Then the rays must
/// leave farther away: surface.offset grows. A surface in the same place that bounds nothing hides the
/// boundary: `hit` and `surface` become those of it, and the result is empty.
std::optional<Boundary> find_boundary(const TraceContext& context, const MediumStack& media, const Ray& ray,
                                      std::uint32_t random, Hit& hit, Surface& surface);

/// Index of refraction of what may be vacuum, at a wavelength (0: the d line).
inline float ior_of(const Medium* medium, float wavelength) {
  return medium ? eval_ior(*medium, wavelength) : 1;
}

/// The share of light that is left, and not scattered, after a distance in metres, which may be infinite.
Rgb transmittance(const Medium* medium, float distance);

}  // namespace parian
