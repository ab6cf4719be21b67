/// The metallic-roughness surface of glTF 2.0 (appendix B): a diffuse base under a dielectric microfacet
/// coat, mixed with a metal of the same microfacets.
#pragma once

#include <optional>

#include "materials/facet_bounces.h"
#include "materials/ggx.h"
#include "materials/lobe.h"
#include "renderer/base/sampling.h"
#include "renderer/scene/fresnel.h"

namespace parian {

/// What a metallic-roughness surface adds for light that meets more than one facet, made once for a surface
/// by make_compensation(). Es is the albedo of the dielectric coat with its multiple scattering, in the
/// strongest channel of f0.
struct Compensation {
  FacetBounces bounces;                    // of metal and coat
  float coat_f0, coat_f90, coat_multiple;  // Es = coat_f0 a + coat_f90 b + coat_multiple (1 - E)
  float per_transmitted;                   // 1 over the average of 1 - Es
  // Luminance of what single scattering reflects is single_f0 a + single_f90 b.
  float single_f0, single_f90;

  /// 1 - Es.
  float coat_transmits(const GgxAlbedo& e) const {
    return std::max(0.0f, 1 - (coat_f0 * e.a + coat_f90 * e.b + coat_multiple * e.loss));
  }
  /// What takes the place of 1 - max F, for what lies under the coat.
  float under_coat(const GgxAlbedo& o, const GgxAlbedo& i) const {
    return coat_transmits(o) * coat_transmits(i) * per_transmitted;
  }
};

/// f = (1 - metallic) ((1 - max F) base / pi + F s) + metallic Fm s, where s = D G / (4 cos cos), F is
/// Schlick's dielectric reflectance (KHR_materials_specular) and Fm that of the metal, both at the angle
/// between wo and the half vector.
///
/// This loses what meets a second facet (up to 69% of it, for a white metal of roughness 1 seen from above),
/// and the base comes on top of a coat that reflects at grazing angles (up to 1.7 of what it gets). With a
/// compensation the lobe adds FacetBounces for metal and coat, and its base is
/// (1 - metallic) base (1 - Es(wo)) (1 - Es(wi)) / (pi (1 - Es_avg)): a white surface then reflects what it
/// gets (the base as in Kelemen and Szirmay-Kalos 2001).
struct MetallicRoughness {
  Rgb base;  // base colour
  float metallic;
  Rgb f0;     // dielectric reflectance at normal incidence, specular weight included
  float f90;  // and at grazing: the specular weight
  Ggx ggx;
  std::optional<Compensation> compensation = {};  // none: single scattering, as glTF has it

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const { return eval(wo, wi, seen_from(wo)); }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u1, const Vec2f& u2) const {
    const View view = seen_from(wo);
    Vec3f wi;
    if (u1 < view.facets) {
      const Vec3f h = ggx.sample_visible_normal(wo, u2);
      wi = h * (2 * wo.dot(h)) - wo;
    } else {
      wi = sample_cosine_hemisphere(u2);
    }
    const BsdfValue value = eval(wo, wi, view);
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

  /// What does not depend on wi: the probability with which sample() takes a facet, about the share of light
  /// that facets reflect; both components keep a chance. And the albedo of compensated facets.
  struct View {
    float facets;
    GgxAlbedo albedo;
  };
  View seen_from(const Vec3f& wo) const {
    if (compensation) {
      const GgxAlbedo albedo = compensation->bounces.row.at(wo.z);
      return {single_probability(albedo), albedo};
    }
    const Reflectance r = reflectance(wo.z);
    const float specular = luminance(r.specular), diffuse = luminance(r.diffuse);
    if (diffuse <= 0) return {1, {}};
    return {std::clamp(specular / (specular + diffuse), 0.1f, 0.9f), {}};
  }

  /// The share of single scattering in what a compensated lobe reflects. Facets keep a chance that bounds the
  /// weights where F is far above its mean; the rest needs no more than its share, for it is nearly
  /// cosine-distributed.
  float single_probability(const GgxAlbedo& e) const {
    const Compensation& c = *compensation;
    const float single = c.single_f0 * e.a + c.single_f90 * e.b;
    const float rest = c.bounces.albedo * e.loss + luminance(base) * (1 - metallic) * c.coat_transmits(e);
    return std::clamp(single / (single + rest), 0.1f, 0.999f);
  }

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi, const View& view) const {
    if (wi.z <= 0) return {};
    const Vec3f h = normalize(wo + wi);
    const Reflectance r = reflectance(wo.dot(h));
    // Of the visible normals' density, G1 D wo.h / cos wo, divided by 4 wo.h, the wo.h cancel: at grazing
    // angles, where rounding may turn a facet away, f and density stay in proportion.
    const float facets = ggx.d(h) / (4 * wo.z);
    const Rgb rest = (compensation ? many_facets(view.albedo, wi) : r.diffuse * kInvPi) * wi.z;
    return {rest + r.specular * (facets * ggx.g2(wo, wi)),
            view.facets * facets * ggx.g1(wo) + (1 - view.facets) * kInvPi * wi.z};
  }

  /// f of all that a compensated lobe does not reflect by one facet. `o`: at wo.
  Rgb many_facets(const GgxAlbedo& o, const Vec3f& wi) const {
    const GgxAlbedo i = compensation->bounces.row.at(wi.z);
    return compensation->bounces.eval(o.loss, i.loss) +
           base * ((1 - metallic) * kInvPi * compensation->under_coat(o, i));
  }
};
static_assert(Lobe<MetallicRoughness>);

/// Of a metal `base` and a dielectric coat of f0 to f90, f0 <= f90, with facets of alpha in
/// [Ggx::kMinAlpha, 1].
inline Compensation make_compensation(const Rgb& base, float metallic, const Rgb& f0, float f90,
                                      float alpha) {
  const GgxAlbedoRow row = GgxAlbedoRow::make(alpha);
  const auto bounced = [&](float least, float most) {
    return bounced_reflectance(least + (most - least) * (1 / 21.0f), row.average_loss);  // Schlick's average
  };
  Rgb multiple;
  for (int k = 0; k < 3; ++k)
    multiple[k] = (1 - metallic) * bounced(f0[k], f90) + metallic * bounced(base[k], 1);
  const float coat_f0 = max_component(f0), coat_multiple = bounced(coat_f0, f90);
  const float transmitted =
      1 - (coat_f0 * row.average_a + f90 * row.average_b + coat_multiple * row.average_loss);
  return {
      make_facet_bounces(row, multiple),
      coat_f0,
      f90,
      coat_multiple,
      1 / std::max(transmitted, 1e-4f),  // a perfect coat lets nothing through: 0 is divided
      luminance(f0) * (1 - metallic) + luminance(base) * metallic,
      f90 * (1 - metallic) + metallic,
  };
}

/// The same surface with its multiple scattering.
inline MetallicRoughness make_compensated(MetallicRoughness lobe) {
  lobe.compensation = make_compensation(lobe.base, lobe.metallic, lobe.f0, lobe.f90, lobe.ggx.alpha);
  return lobe;
}

}  // namespace parian
