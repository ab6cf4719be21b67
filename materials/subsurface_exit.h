/// How diffused light leaves a dense body.
#pragma once

#include "materials/lobe.h"
#include "renderer/base/sampling.h"
#include "renderer/scene/fresnel.h"

namespace parian {

/// S_w of the separable BSSRDF (Pharr, Jakob and Humphreys, Physically Based Rendering, 11.4), with the tint
/// of the surface: f cos = tint (1 - F(cos wi)) cos wi / (pi c), c such that all of it is `tint`. It does not
/// depend on wo, which only says on which side.
struct SubsurfaceExit {
  float eta;        // of the body, against what is outside
  float inverse_c;  // make_inverse_c(eta)
  Rgb tint;

  /// 1 / c, c = 1 - 2 integral F(mu) mu dmu, of F from outside.
  static float make_inverse_c(float eta) { return float(1 / (1 - 2 * fresnel_moment(eta, 1))); }

  BsdfValue eval(const Vec3f&, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    const float pdf = kInvPi * wi.z;
    return {tint * (pdf * share(wi.z)), pdf};
  }

  std::optional<BsdfSample> sample(const Vec3f&, float, const Vec2f& u2) const {
    const Vec3f wi = sample_cosine_hemisphere(u2);
    if (!(wi.z > 0)) return std::nullopt;
    return BsdfSample{wi, tint * share(wi.z), kInvPi * wi.z};
  }

 private:
  float share(float cosine) const { return inverse_c * (1 - fresnel_dielectric(cosine, eta)); }
};
static_assert(Lobe<SubsurfaceExit>);

}  // namespace parian
