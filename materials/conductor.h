/// A metal by its refractive index: microfacets that reflect as Fresnel's equations say, or a mirror.
#pragma once

#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/lobe.h"

namespace parian {

/// f = F D G / (4 cos cos), F at the angle between wo and the half vector (Walter et al. 2007, eq. 20).
struct Conductor {
  Rgb eta, k;  // refractive index eta + ik, relative to what is outside; >= 0
  Ggx ggx;     // alpha below Ggx::kMinAlpha: a mirror

  /// eval() is nothing then, and sample() finds the mirror direction with infinite density.
  bool is_mirror() const { return ggx.alpha < Ggx::kMinAlpha; }

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0 || is_mirror()) return {};
    const Vec3f h = normalize(wo + wi);
    // Of the visible normals' density, G1 D wo.h / cos wo, divided by 4 wo.h, the wo.h cancel.
    const float d = ggx.d(h) / (4 * wo.z);
    const Rgb f = fresnel_conductor(std::clamp(wo.dot(h), 0.0f, 1.0f), eta, k);
    return {f * (d * ggx.g2(wo, wi)), d * ggx.g1(wo)};
  }

  /// Fails where a facet reflects below the horizon.
  std::optional<BsdfSample> sample(const Vec3f& wo, float, const Vec2f& u2) const {
    if (is_mirror()) return BsdfSample{{-wo.x, -wo.y, wo.z}, fresnel_conductor(wo.z, eta, k), kInfinity};
    const Vec3f h = ggx.sample_visible_normal(wo, u2);
    const Vec3f wi = h * (2 * wo.dot(h)) - wo;
    const BsdfValue value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos * (1 / value.pdf), value.pdf};
  }
};
static_assert(Lobe<Conductor>);

}  // namespace parian
