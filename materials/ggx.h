/// The GGX (Trowbridge-Reitz) distribution of microfacet normals with Smith's height-correlated masking,
/// isotropic. Directions are in the shading frame, unit.
#pragma once

#include "renderer/base/math.h"

namespace parian {

/// A facet normal as seen from wo, of a roughness for each axis (Dupuy and Benyoub 2023, Sampling Visible GGX
/// Normals with Spherical Caps).
inline Vec3f sample_visible_ggx_normal(const Vec3f& wo, float alpha_x, float alpha_y, const Vec2f& u) {
  const Vec3f warped = normalize(Vec3f(wo.x * alpha_x, wo.y * alpha_y, wo.z));
  const float phi = 2 * kPi * u.x;
  const float z = (1 - u.y) * (1 + warped.z) - warped.z;
  const float r = std::sqrt(std::clamp(1 - z * z, 0.0f, 1.0f));
  const Vec3f c = Vec3f(r * std::cos(phi), r * std::sin(phi), z) + warped;
  return normalize(Vec3f(c.x * alpha_x, c.y * alpha_y, std::max(c.z, 1e-20f)));
}

struct Ggx {
  float alpha;  // roughness squared

  /// Below this a lobe is narrower than single precision resolves well; a mirror is rendered as this lobe.
  static constexpr float kMinAlpha = 1e-4f;

  /// Density of facet normals D(h), per projected area and solid angle. Written without 1 - cos^2, which
  /// cancels for small alpha (Walter et al. 2007, eq. 33).
  float d(const Vec3f& h) const {
    const float a2 = alpha * alpha;
    const float t = (h.x * h.x + h.y * h.y) / a2 + h.z * h.z;
    return kInvPi / (a2 * t * t);
  }

  /// Lambda of Smith's masking (Heitz 2014, eq. 72).
  float lambda(const Vec3f& w) const {
    const float cos2 = w.z * w.z;
    const float tan2 = (w.x * w.x + w.y * w.y) / cos2;
    return 0.5f * (std::sqrt(1 + alpha * alpha * tan2) - 1);
  }

  float g1(const Vec3f& w) const { return 1 / (1 + lambda(w)); }
  /// Height-correlated masking and shadowing (Heitz 2014, eq. 99).
  float g2(const Vec3f& wo, const Vec3f& wi) const { return 1 / (1 + lambda(wo) + lambda(wi)); }

  /// Density of sample_visible_normal() at h: G1 D max(0, wo.h) / cos wo.
  float pdf_visible_normal(const Vec3f& wo, const Vec3f& h) const {
    return g1(wo) * d(h) * std::max(0.0f, wo.dot(h)) / wo.z;
  }

  /// A facet normal as seen from wo.
  Vec3f sample_visible_normal(const Vec3f& wo, const Vec2f& u) const {
    return sample_visible_ggx_normal(wo, alpha, alpha, u);
  }
};

}  // namespace parian
