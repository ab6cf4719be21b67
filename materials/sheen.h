/// The sheen of cloth (KHR_materials_sheen): light that fibres near the normal scatter at grazing angles.
#pragma once

#include "materials/albedo.h"
#include "materials/lobe.h"
#include "renderer/base/sampling.h"

namespace parian {

/// f = color D G / (4 cos cos) with the Charlie distribution of facets and its fitted masking (Estevez and
/// Kulla 2017, Production Friendly Microfacet Sheen BRDF). The paper's softer terminator is left out, as in
/// KHR_materials_sheen: it is not reciprocal.
///
/// The model reflects more than it gets near the horizon where it is smooth (measured: roughness .07 up
/// to 2.9 for mu below .052, .1 up to 2.1, .2 up to 1.2 below .023; from .3 on, less than 1). The fit is
/// finite at the horizon, where f then grows like 1 / cos: for mu below 5e-6 all exceed 1.
struct Sheen {
  Rgb color;
  float alpha;  // sheen roughness squared; in [kMinAlpha, 1]

  /// Roughness .07, where the lobe is a rim of some degrees that reflects three times what it gets. D is
  /// exact to 5e-5 in single precision from here on.
  static constexpr float kMinAlpha = 0.0049f;

  /// Density of facet normals, Charlie: a power of the sine.
  float d(const Vec3f& h) const {
    const float exponent = 1 / alpha;
    return (2 + exponent) * std::pow(h.x * h.x + h.y * h.y, 0.5f * exponent) * (0.5f * kInvPi);
  }

  /// Lambda of the masking, by the paper's fit (constants as in KHR_materials_sheen).
  float lambda(float cosine) const {
    const float s = (1 - alpha) * (1 - alpha);
    const auto at = [&](float rough, float smooth) { return rough + (smooth - rough) * s; };
    const float a = at(21.5473f, 25.3245f), b = at(3.82987f, 3.32435f), c = at(0.19823f, 0.16801f),
                d = at(-1.97760f, -1.27393f), e = at(-4.32054f, -4.85967f);
    const auto curve = [&](float x) { return a / (1 + b * std::pow(x, c)) + d * x + e; };
    // Symmetric about a half, in the logarithm.
    return std::exp(cosine < 0.5f ? curve(cosine) : 2 * curve(0.5f) - curve(std::max(0.0f, 1 - cosine)));
  }

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    const float masked = 1 + lambda(wo.z) + lambda(wi.z);
    return {color * (d(normalize(wo + wi)) / (masked * (4 * wo.z))), 0.5f * kInvPi};
  }

  /// Uniform over the hemisphere: most of the lobe is near the horizon, where the cosine is not. Standard
  /// deviation of a weight over its mean, seen from mu = .5: .46 for roughness 1 and 1.8 for .2 (cosine: .50
  /// and 3.7).
  std::optional<BsdfSample> sample(const Vec3f& wo, float, const Vec2f& u) const {
    const float z = 1 - u.x;
    const Vec2f p = unit_circle(u.y) * std::sqrt(std::max(0.0f, 1 - z * z));
    const Vec3f wi(p.x, p.y, z);
    const BsdfValue value = eval(wo, wi);
    return BsdfSample{wi, value.f_cos * (1 / value.pdf), value.pdf};
  }

  /// What a layer below is multiplied by, so that both reflect no more than they get (KHR_materials_sheen,
  /// albedo scaling); 0 where the sheen alone does. Reciprocal.
  float base_scale(const Vec3f& wo, const Vec3f& wi) const {
    const float albedo = std::max(sheen_albedo(wo.z, alpha), sheen_albedo(std::abs(wi.z), alpha));
    return std::max(0.0f, 1 - max_component(color) * albedo);
  }
};
static_assert(Lobe<Sheen>);

}  // namespace parian
