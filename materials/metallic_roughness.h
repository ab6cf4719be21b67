/// The metallic-roughness surface of glTF 2.0 (appendix B): a diffuse base under a dielectric microfacet
/// coat, mixed with a metal of the same microfacets.
#pragma once

#include "materials/ggx.h"
#include "materials/lobe.h"
#include "renderer/base/sampling.h"

namespace parian {

/// f = (1 - metallic) ((1 - max F) base / pi + F s) + metallic Fm s, where s = D G / (4 cos cos), F is
/// Schlick's dielectric reflectance (KHR_materials_specular) and Fm that of the metal, both at the angle
/// between wo and the half vector.
struct MetallicRoughness {
  Rgb base;  // base colour
  float metallic;
  Rgb f0;     // dielectric reflectance at normal incidence, specular weight included
  float f90;  // and at grazing: the specular weight
  Ggx ggx;

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    const Vec3f h = normalize(wo + wi);
    const Reflectance r = reflectance(wo.dot(h));
    // D G / (4 cos cos), times cos wi.
    const float specular = ggx.d(h) * ggx.g2(wo, wi) / (4 * wo.z);
    const float choice = specular_probability(wo);
    return {r.diffuse * (kInvPi * wi.z) + r.specular * specular,
            choice * ggx.pdf_visible_normal(wo, h) / (4 * wo.dot(h)) + (1 - choice) * kInvPi * wi.z};
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u1, const Vec2f& u2) const {
    Vec3f wi;
    if (u1 < specular_probability(wo)) {
      const Vec3f h = ggx.sample_visible_normal(wo, u2);
      wi = h * (2 * wo.dot(h)) - wo;
    } else {
      wi = sample_cosine_hemisphere(u2);
    }
    const BsdfValue value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos * (1 / value.pdf), value.pdf};
  }

 private:
  struct Reflectance {
    Rgb diffuse, specular;
  };

  Reflectance reflectance(float cosine) const {
    const float grazing = schlick_weight(cosine);
    const Rgb dielectric = f0 + (Rgb(f90, f90, f90) - f0) * grazing;
    const Rgb metal = base + (Rgb(1, 1, 1) - base) * grazing;
    return {base * ((1 - metallic) * (1 - max_component(dielectric))),
            dielectric * (1 - metallic) + metal * metallic};
  }

  static float schlick_weight(float cosine) {
    const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
    return (m * m) * (m * m) * m;
  }

  /// About the share of light that the microfacets reflect, seen from wo; both components keep a chance.
  float specular_probability(const Vec3f& wo) const {
    const Reflectance r = reflectance(wo.z);
    const float specular = luminance(r.specular), diffuse = luminance(r.diffuse);
    if (diffuse <= 0) return 1;
    return std::clamp(specular / (specular + diffuse), 0.1f, 0.9f);
  }
};
static_assert(Lobe<MetallicRoughness>);

}  // namespace parian
