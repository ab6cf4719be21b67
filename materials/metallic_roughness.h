/// The metallic-roughness surface of glTF 2.0 (appendix B): a diffuse base under a dielectric microfacet
/// coat, mixed with a metal of the same microfacets.
#pragma once

#include <optional>

#include "materials/albedo.h"
#include "materials/fresnel.h"
#include "materials/ggx.h"
#include "materials/lobe.h"
#include "renderer/base/sampling.h"

namespace parian {

/// What a MetallicRoughness adds for light that meets more than one facet, made once for a surface by
/// make_compensated(). E is the albedo of the facets for a reflectance of 1, Es that of the dielectric coat
/// with its multiple scattering, in the strongest channel of f0; avg is over the hemisphere.
struct Compensation {
  GgxAlbedoRow row;
  Rgb multiple;             // of (1 - E(wo)) (1 - E(wi)), in f
  Rgb diffuse;              // of (1 - Es(wo)) (1 - Es(wi)), in f
  float coat_f0, coat_f90;  // Es = coat_f0 a + coat_f90 b + coat_multiple (1 - E)
  float coat_multiple;
  // Luminance of what single scattering reflects, s_f0 a + s_f90 b; and of the albedos of `multiple` over
  // 1 - E(wo), of `diffuse` over 1 - Es(wo).
  float single_f0, single_f90, multiple_albedo, diffuse_albedo;

  /// 1 - Es.
  float coat_transmits(const GgxAlbedo& e) const {
    return std::max(0.0f, 1 - (coat_f0 * e.a + coat_f90 * e.b + coat_multiple * e.loss));
  }
};

/// f = (1 - metallic) ((1 - max F) base / pi + F s) + metallic Fm s, where s = D G / (4 cos cos), F is
/// Schlick's dielectric reflectance (KHR_materials_specular) and Fm that of the metal, both at the angle
/// between wo and the half vector.
///
/// This loses what meets a second facet (up to 69% of it, for a white metal of roughness 1 seen from above),
/// and the base comes on top of a coat that reflects at grazing angles (up to 1.7 of what it gets). With a
/// compensation (make_compensated()) the lobe adds Fms (1 - E(wo)) (1 - E(wi)) / (pi (1 - Eavg)) for metal
/// and coat, and its base is (1 - metallic) base (1 - Es(wo)) (1 - Es(wi)) / (pi (1 - Es_avg)): a white
/// surface then reflects what it gets (Kulla and Conty 2017, Revisiting Physically Based Shading at
/// Imageworks; the base as in Kelemen and Szirmay-Kalos 2001).
struct MetallicRoughness {
  Rgb base;  // base colour
  float metallic;
  Rgb f0;     // dielectric reflectance at normal incidence, specular weight included
  float f90;  // and at grazing: the specular weight
  Ggx ggx;
  std::optional<Compensation> compensation = {};  // none: single scattering, as glTF has it

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    const Vec3f h = normalize(wo + wi);
    const Reflectance r = reflectance(wo.dot(h));
    // Of the visible normals' density, G1 D wo.h / cos wo, divided by 4 wo.h, the wo.h cancel: at grazing
    // angles, where rounding may turn a facet away, f and density stay in proportion.
    const float facets = ggx.d(h) / (4 * wo.z);
    const float choice = specular_probability(wo);
    const Rgb rest = compensation ? many_facets(wo, wi) * wi.z : r.diffuse * (kInvPi * wi.z);
    return {rest + r.specular * (facets * ggx.g2(wo, wi)),
            choice * facets * ggx.g1(wo) + (1 - choice) * kInvPi * wi.z};
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

  /// f of all that a compensated lobe does not reflect by one facet.
  Rgb many_facets(const Vec3f& wo, const Vec3f& wi) const {
    const GgxAlbedo o = compensation->row.at(wo.z), i = compensation->row.at(wi.z);
    return compensation->multiple * (o.loss * i.loss) +
           compensation->diffuse * (compensation->coat_transmits(o) * compensation->coat_transmits(i));
  }

  /// About the share of light that the microfacets reflect, seen from wo; both components keep a chance.
  float specular_probability(const Vec3f& wo) const {
    if (compensation) return single_probability(compensation->row.at(wo.z));
    const Reflectance r = reflectance(wo.z);
    const float specular = luminance(r.specular), diffuse = luminance(r.diffuse);
    if (diffuse <= 0) return 1;
    return std::clamp(specular / (specular + diffuse), 0.1f, 0.9f);
  }

  /// The share of single scattering in what a compensated lobe reflects. Facets keep a chance that bounds the
  /// weights where F is far above its mean; the rest needs no more than its share, for it is nearly
  /// cosine-distributed.
  float single_probability(const GgxAlbedo& e) const {
    const Compensation& c = *compensation;
    const float single = c.single_f0 * e.a + c.single_f90 * e.b;
    const float rest = c.multiple_albedo * e.loss + c.diffuse_albedo * c.coat_transmits(e);
    return std::clamp(single / (single + rest), 0.1f, 0.999f);
  }
};
static_assert(Lobe<MetallicRoughness>);

/// The same surface with its multiple scattering. f0 <= f90 and alpha in [Ggx::kMinAlpha, 1].
inline MetallicRoughness make_compensated(MetallicRoughness lobe) {
  const GgxAlbedoRow row = GgxAlbedoRow::make(lobe.ggx.alpha);
  // Kulla and Conty's Fms, a geometric series over the bounces; 20 / 21 and 1 / 21 are the averages of
  // Schlick.
  const auto multiple_reflectance = [&](float f0, float f90) {
    const float average = f0 + (f90 - f0) * (1 / 21.0f);
    return average * average * (1 - row.average_loss) / (1 - average * row.average_loss);
  };
  const float dielectric = 1 - lobe.metallic;
  Rgb multiple;
  for (int k = 0; k < 3; ++k)
    multiple[k] = dielectric * multiple_reflectance(lobe.f0[k], lobe.f90) +
                  lobe.metallic * multiple_reflectance(lobe.base[k], 1);
  const float f0 = max_component(lobe.f0), coat_multiple = multiple_reflectance(f0, lobe.f90);
  const float transmitted =
      1 - (f0 * row.average_a + lobe.f90 * row.average_b + coat_multiple * row.average_loss);
  // A smooth surface loses nothing but where mu is about alpha: bounded so that weights are, which leaves out
  // a part of that for roughness below .08. A perfect coat lets nothing through: 0 is divided.
  const float per_loss = kInvPi / std::max(row.average_loss, 3e-4f),
              per_transmitted = kInvPi / std::max(transmitted, 1e-4f);
  lobe.compensation = Compensation{
      row,
      multiple * per_loss,
      lobe.base * (dielectric * per_transmitted),
      f0,
      lobe.f90,
      coat_multiple,
      luminance(lobe.f0) * dielectric + luminance(lobe.base) * lobe.metallic,
      lobe.f90 * dielectric + lobe.metallic,
      luminance(multiple),
      luminance(lobe.base) * dielectric,
  };
  return lobe;
}

}  // namespace parian
