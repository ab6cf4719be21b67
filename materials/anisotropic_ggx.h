/// The GGX distribution stretched along the x axis of the shading frame: ggx.h with a roughness for each
/// axis, in a file of its own because the isotropic one is cheaper. With alpha_x = alpha_y they are the same.
#pragma once

#include "materials/ggx.h"

namespace parian {

struct AnisotropicGgx {
  float alpha_x, alpha_y;  // each in [Ggx::kMinAlpha, 1]

  /// Density of facet normals D(h), per projected area and solid angle (Burley 2012, Physically-Based Shading
  /// at Disney).
  float d(const Vec3f& h) const {
    const float x = h.x / alpha_x, y = h.y / alpha_y;
    const float t = x * x + y * y + h.z * h.z;
    return kInvPi / (alpha_x * alpha_y * t * t);
  }

  /// Lambda of Smith's masking, with the roughness in the azimuth of w (Heitz 2014).
  float lambda(const Vec3f& w) const {
    const float x = w.x * alpha_x, y = w.y * alpha_y;
    return 0.5f * (std::sqrt(1 + (x * x + y * y) / (w.z * w.z)) - 1);
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
    return sample_visible_ggx_normal(wo, alpha_x, alpha_y, u);
  }
};

}  // namespace parian
