/// The diffuse lobe.
#pragma once

#include "materials/lobe.h"
#include "renderer/base/sampling.h"

namespace parian {

/// f = albedo / pi.
struct Lambert {
  Rgb albedo;

  BsdfValue eval(const Vec3f&, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    return {albedo * (kInvPi * wi.z), kInvPi * wi.z};
  }

  std::optional<BsdfSample> sample(const Vec3f&, float, const Vec2f& u) const {
    const Vec3f wi = sample_cosine_hemisphere(u);
    if (wi.z <= 0) return std::nullopt;
    return BsdfSample{wi, albedo, kInvPi * wi.z};
  }
};
static_assert(Lobe<Lambert>);

}  // namespace parian
