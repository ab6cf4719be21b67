/// The random walk of light in a medium that scatters it: the truth that diffusion approximates.
#pragma once

#include "renderer/session/integrator.h"

namespace parian {

/// What a walk has become.
enum class Walk : std::uint8_t {
  straight,   // it met a surface, or left the scene, without being scattered
  scattered,  // the same after it was
  ended       // it was absorbed
};

/// Follows `ray`, which is in the medium and began there a distance `lead` before its origin (as one does
/// that left a surface), from one scattering to the next until it meets a surface or leaves the scene: then
/// `ray` is its last piece and `hit` what that met. `weight` is multiplied by f / pdf of all that happened,
/// the roulette of absorption included; it is the same in all channels that the medium treats alike.
/// Distances are sampled for one colour channel, chosen by what the path carries, and weighed by the density
/// of all three, which bounds the weight; directions by Henyey and Greenstein's phase function.
///
/// Where nothing absorbs, a walk deep inside a large body takes as many steps as the square of its size in
/// mean free paths. From kLongWalk steps on, each time that their number has doubled, one in sqrt(2) goes on:
/// since the chance to be inside after n steps falls as n^-1/2, neither the time of long walks nor their
/// variance grows but by the logarithm. After kLongestWalk steps it is given up.
Walk walk(const TraceContext& context, const Medium& medium, float lead, Ray& ray, Hit& hit, Rgb& weight,
          Sampler& sampler, RayCounts& counts);

inline constexpr int kLongWalk = 1 << 12, kLongestWalk = 1 << 20;

/// A direction after scattering by Henyey and Greenstein's phase function with mean cosine g, |g| < 1; d is
/// where light (or the path) goes before, the result where it goes after. Density (1 - g^2) / (4 pi (1 + g^2
/// - 2 g cos)^1.5) per solid angle.
Vec3f sample_henyey_greenstein(const Vec3f& d, float g, const Vec2f& u);

}  // namespace parian
