/// Diffusion below the surface of a dense body by probe rays: where light that went in comes out.
#pragma once

#include <vector>

#include "integrators/integrators.h"
#include "materials/radial_profile.h"

namespace parian {

/// A medium as diffusion sees it; one for each of World::media, of use where that scatters.
struct DiffuseMedium {
  std::array<RadialProfile, 3> profiles;  // by colour channel
  Rgb reflectance;                        // the share of what entered a thick flat body that comes out again
  float inverse_c;                        // SubsurfaceExit::inverse_c
  // Metres: the diffusion length 1 / sigma_tr and a mean free path, the largest of the channels; may be
  // infinite. Diffusion is wrong where a body is as thin, or as bent, as some of these.
  float blur;
  float free_path;  // metres: 1 / sigma_t', the smallest of the channels
};

/// With the model that is asked for; for Subsurface::automatic that of photon beams, scaled so that a thick
/// flat body reflects what a random walk in it would.
std::vector<DiffuseMedium> make_diffuse_media(const World& world, Subsurface method);

/// What becomes of light that goes into a dense body.
enum class Inside : std::uint8_t { travels, diffuses, returns };

/// Chooses for light that enters at `surface`; `alone`: from vacuum, into the body whose surface that is. By
/// the method where it says; diffusion knows no other bodies, so there light travels; and what stays below
/// the rounding of the place comes back from there. Subsurface::automatic diffuses where nothing is near
/// below the surface, in a direction by chance: the share of the directions in which something is grows
/// smoothly from broad to thin parts, and so does that of walks.
Inside choose_inside(const TraceContext& context, Subsurface method, const DiffuseMedium& medium,
                     const Surface& surface, bool alone, Sampler& sampler, RayCounts& counts);

/// Where light comes out: the surface there seen from outside along its normal, and the profile there over
/// the density with which the place was sampled, per channel.
struct Emergence {
  Surface surface;
  Rgb weight;
};

/// Samples a place for light that enters at `entry`, which the ray hit as `hit`, by a probe ray along one of
/// three axes through a point at a distance sampled from one channel's profile (King, Kulla, Conty and
/// Fajardo 2013, BSSRDF Importance Sampling). The density is that of all axes and of all channels whose probe
/// reaches the place: those that do not, because their profile ends before, cannot have found it. Of all that
/// the probe crosses of the same body one place is taken by what it contributes to `carried`, the path's
/// weight so far. Nothing where the probe misses.
std::optional<Emergence> sample_emergence(const TraceContext& context, const DiffuseMedium& medium,
                                          const Surface& entry, const Hit& hit, const Rgb& carried,
                                          Sampler& sampler);

}  // namespace parian
