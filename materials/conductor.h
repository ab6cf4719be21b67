/// A metal by its refractive index: microfacets that reflect as Fresnel's equations say, or a mirror.
#pragma once

#include <optional>

#include "materials/facet_bounces.h"
#include "materials/ggx.h"
#include "materials/lobe.h"
#include "renderer/base/sampling.h"
#include "renderer/scene/fresnel.h"

namespace parian {

/// f = F D G / (4 cos cos), F at the angle between wo and the half vector (Walter et al. 2007, eq. 20). With
/// `bounces` (make_compensated()) plus what meets more than one facet.
struct Conductor {
  Rgb eta, k;  // refractive index eta + ik, relative to what is outside; >= 0
  Ggx ggx;     // alpha below Ggx::kMinAlpha: a mirror
  std::optional<FacetBounces> bounces = {};

  /// eval() is nothing then, and sample() finds the mirror direction with infinite density.
  bool is_mirror() const { return ggx.alpha < Ggx::kMinAlpha; }

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0 || is_mirror()) return {};
    const Vec3f h = normalize(wo + wi);
    // Of the visible normals' density, G1 D wo.h / cos wo, divided by 4 wo.h, the wo.h cancel.
    const float d = ggx.d(h) / (4 * wo.z);
    const Rgb f = fresnel_conductor(std::clamp(wo.dot(h), 0.0f, 1.0f), eta, k);
    const BsdfValue once{f * (d * ggx.g2(wo, wi)), d * ggx.g1(wo)};
    if (!bounces) return once;
    const float loss = bounces->row.at(wo.z).loss, choice = bounce_probability(loss);
    return {once.f_cos + bounces->eval(loss, bounces->row.at(wi.z).loss) * wi.z,
            (1 - choice) * once.pdf + choice * kInvPi * wi.z};
  }

  /// Fails where a facet reflects below the horizon.
  std::optional<BsdfSample> sample(const Vec3f& wo, float u1, const Vec2f& u2) const {
    if (is_mirror()) return BsdfSample{{-wo.x, -wo.y, wo.z}, fresnel_conductor(wo.z, eta, k), kInfinity};
    Vec3f wi;
    if (bounces && u1 < bounce_probability(bounces->row.at(wo.z).loss)) {
      wi = sample_cosine_hemisphere(u2);
    } else {
      const Vec3f h = ggx.sample_visible_normal(wo, u2);
      wi = h * (2 * wo.dot(h)) - wo;
    }
    const BsdfValue value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos * (1 / value.pdf), value.pdf};
  }

 private:
  /// About the share of what meets more than one facet, at a place that loses so much.
  float bounce_probability(float loss) const {
    return std::min(0.9f, bounces->albedo * loss / (1 - loss + bounces->albedo * loss));
  }
};
static_assert(Lobe<Conductor>);

/// The same metal with its multiple scattering; a mirror has none.
inline Conductor make_compensated(Conductor lobe) {
  if (lobe.is_mirror()) return lobe;
  const GgxAlbedoRow row = GgxAlbedoRow::make(lobe.ggx.alpha);
  // The average 2 integral of F mu dmu by two nodes (Gauss and Jacobi), off by .006 at most.
  const Rgb average = fresnel_conductor(0.355051f, lobe.eta, lobe.k) * 0.363917f +
                      fresnel_conductor(0.844949f, lobe.eta, lobe.k) * 0.636083f;
  Rgb reflectance;
  for (int k = 0; k < 3; ++k) reflectance[k] = bounced_reflectance(average[k], row.average_loss);
  lobe.bounces = make_facet_bounces(row, reflectance);
  return lobe;
}

}  // namespace parian
