/// What a lobe is: a value type that evaluates and samples a BSDF in the shading frame (z is the shading
/// normal, on the side of the viewer). wo points to the viewer and wi to the light, both unit, both away from
/// the surface; wo.z > 0. Light is transmitted where wi.z < 0.
#pragma once

#include <concepts>
#include <optional>

#include "renderer/base/math.h"

namespace parian {

/// f(wo, wi) |cos wi|, and the density per solid angle with which sample() finds wi. A direction that only
/// sampling finds, as a mirror's, is in neither.
struct BsdfValue {
  Rgb f_cos{0, 0, 0};
  float pdf = 0;
};

struct BsdfSample {
  Vec3f wi;
  Rgb weight;  // f |cos wi| / pdf
  float pdf;   // per solid angle; > 0, and infinite for a direction that only sampling finds
};

template <class T>
concept Lobe = requires(const T& lobe, const Vec3f& w, float u1, const Vec2f& u2) {
  { lobe.eval(w, w) } -> std::same_as<BsdfValue>;
  // u1 chooses between components where there are several, u2 the direction; nothing where the sample failed.
  { lobe.sample(w, u1, u2) } -> std::same_as<std::optional<BsdfSample>>;
};

}  // namespace parian
