/// The interface between two dielectrics, smooth or rough, and the thin wall of one.
#pragma once

#include <variant>

#include "materials/albedo.h"
#include "materials/ggx.h"
#include "materials/lobe.h"
#include "renderer/scene/fresnel.h"

namespace parian {

/// Reflection and transmission by exact Fresnel reflectance F on GGX facets (Walter et al. 2007, Microfacet
/// Models for Refraction through Rough Surfaces), on a mirror where ggx.alpha is 0. What is not reflected is
/// transmitted, times `tint`: refracted, or, through a thin wall, straight on, spread as the reflection is
/// (KHR_materials_transmission; physically a wall reflects between its faces too: 2 F / (1 + F)).
///
/// Facets lose what meets a second one. With `losses` (make_compensated()) all that leaves towards wo is
/// scaled so that nothing is lost (as Turquin 2019, Practical multiple scattering compensation for microfacet
/// models, for reflection); the lobe is then not reciprocal.
///
/// Transmitted radiance is the basic radiance L / n^2, which an interface keeps: who wants radiance itself
/// multiplies by (n on wo's side / n on wi's side)^2.
struct Dielectric {
  float eta;  // index of refraction beyond the surface over that on the viewer's side; > 0
  Rgb tint;
  Ggx ggx;
  bool thin;
  // Reflectance is f0 + (f90 - f0) s, where s = (F - F(0)) / (1 - F(0)): F itself where they are F(0) and 1
  // (KHR_materials_specular otherwise).
  Rgb f0;
  float f90;
  std::variant<std::monostate, InterfaceAlbedoRow, GgxAlbedoRow> losses = {};

  /// Whether its directions are found by sampling alone.
  bool is_smooth() const { return ggx.alpha == 0 || (eta == 1 && !thin); }

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const {
    if (is_smooth() || wi.z == 0) return {};
    if (wi.z < 0) {
      const Transmitted t = eval_transmitted(wo, wi);
      return {t.f_cos, t.pdf * (1 - t.choice)};
    }
    const Vec3f h = normalize(wo + wi);
    const Split split = split_at(wo.dot(h));
    const float facets = ggx.d(h) / (4 * wo.z);
    return {split.reflected * (ggx.g2(wo, wi) * facets * scale(wo)), ggx.g1(wo) * facets * split.choice};
  }

  std::optional<BsdfSample> sample(const Vec3f& wo, float u1, const Vec2f& u2) const {
    const Vec3f h = is_smooth() ? Vec3f(0, 0, 1) : ggx.sample_visible_normal(wo, u2);
    const Split split = split_at(wo.dot(h));
    const bool reflect = u1 < split.choice;
    const std::optional<Vec3f> wi = reflect ? mirror(wo, h) : transmit(wo, h);
    if (!wi) return std::nullopt;
    if (is_smooth()) {
      const Rgb weight =
          reflect ? split.reflected * (1 / split.choice) : split.transmitted * (1 / (1 - split.choice));
      return BsdfSample{*wi, weight, kInfinity};
    }
    const BsdfValue value = eval(wo, *wi);
    if (!(value.pdf > 0 && value.pdf < kInfinity)) return std::nullopt;
    return BsdfSample{*wi, value.f_cos * (1 / value.pdf), value.pdf};
  }

  /// Transmission alone, of a rough interface: what eval() gives for wi below the surface, the density of
  /// sample_transmitted(), the probability with which sample() reflects, and the cosine between wo and facet.
  struct Transmitted {
    Rgb f_cos{0, 0, 0};
    float pdf = 0, choice = 0, cosine = 0;
  };
  Transmitted eval_transmitted(const Vec3f& wo, const Vec3f& wi) const {
    if (thin) {
      const Vec3f up(wi.x, wi.y, -wi.z), h = normalize(wo + up);
      const Split split = split_at(wo.dot(h));
      const float facets = ggx.d(h) / (4 * wo.z);
      return {split.transmitted * (ggx.g2(wo, up) * facets * scale(wo)), ggx.g1(wo) * facets, split.choice,
              wo.dot(h)};
    }
    Vec3f h = wo + wi * eta;
    if (h.z < 0) h = -h;
    h = normalize(h);
    const float cos_o = wo.dot(h), cos_i = -wi.dot(h);
    if (!(cos_o > 0 && cos_i > 0)) return {};
    const Split split = split_at(cos_o);
    const float along = cos_o - eta * cos_i;
    // D dh/dwi, over cos wo (eq. 17).
    const float facets = ggx.d(h) * cos_o * eta * eta * cos_i / (along * along * wo.z);
    if (!(facets < kInfinity)) return {};
    return {split.transmitted * (ggx.g2(wo, wi) * facets * scale(wo)), ggx.g1(wo) * facets, split.choice,
            cos_o};
  }
  std::optional<Vec3f> sample_transmitted(const Vec3f& wo, const Vec2f& u) const {
    return transmit(wo, ggx.sample_visible_normal(wo, u));
  }

  /// What makes up for the losses of light that leaves towards wo; 1 without compensation.
  float scale(const Vec3f& wo) const {
    if (const auto* refracting = std::get_if<InterfaceAlbedoRow>(&losses))
      return 1 / (1 - refracting->loss(wo.z));
    if (const auto* thin_wall = std::get_if<GgxAlbedoRow>(&losses)) return 1 / (1 - thin_wall->at(wo.z).loss);
    return 1;
  }

  /// Reflectance of a facet at an angle of that cosine; exactly 1 at total reflection, whatever f0 and f90.
  Rgb reflectance(float cosine) const {
    const float f = fresnel_dielectric(std::clamp(cosine, 0.0f, 1.0f), eta);
    if (f == 1) return Rgb(1, 1, 1);
    const float r = (eta - 1) / (eta + 1), normal = r * r;
    const float s = normal < 1 ? std::max(0.0f, (f - normal) / (1 - normal)) : 1;
    return f0 + (Rgb(f90, f90, f90) - f0) * s;
  }

 private:
  struct Split {
    Rgb reflected, transmitted;
    float choice;  // the probability of reflection
  };

  Split split_at(float cosine) const {
    const Rgb reflected = reflectance(cosine);
    const Rgb transmitted = tint * (1 - max_component(reflected));
    const float a = max_component(reflected), b = max_component(transmitted);
    return {reflected, transmitted, a + b > 0 ? a / (a + b) : 1};
  }

  static std::optional<Vec3f> mirror(const Vec3f& wo, const Vec3f& h) {
    const Vec3f wi = h * (2 * wo.dot(h)) - wo;
    if (wi.z <= 0) return std::nullopt;
    return wi;
  }
  std::optional<Vec3f> transmit(const Vec3f& wo, const Vec3f& h) const {
    std::optional<Vec3f> wi = thin ? mirror(wo, h) : refract(wo, h, eta);
    if (wi && thin) wi->z = -wi->z;
    if (wi && wi->z >= 0) return std::nullopt;
    return wi;
  }
};
static_assert(Lobe<Dielectric>);

/// The same interface with its multiple scattering; a smooth one has none.
inline Dielectric make_compensated(Dielectric lobe) {
  if (lobe.is_smooth()) return lobe;
  // A thin wall transmits as it reflects, so that it loses what facets lose that reflect all; and those of an
  // index beyond all glass do that.
  constexpr float kMostIndex = 10;
  if (lobe.thin || lobe.eta > kMostIndex || lobe.eta < 1 / kMostIndex)
    lobe.losses = GgxAlbedoRow::make(lobe.ggx.alpha);
  else
    lobe.losses = InterfaceAlbedoRow::make(lobe.ggx.alpha, lobe.eta);
  return lobe;
}

}  // namespace parian
