/// The whole of glTF's surface: the metallic-roughness base with its extensions, for materials that use any.
#pragma once

#include <array>

#include "materials/anisotropic_ggx.h"
#include "materials/dielectric.h"
#include "materials/diffuse_transmission.h"
#include "materials/metallic_roughness.h"
#include "materials/sheen.h"

namespace parian {

/// From the top: a clear coat, sheen, and the base of glTF 2.0, appendix B, where
///   dielectric = F s + (1 - max F) (transmission T + (1 - transmission) diffuse), metal = Fm s,
/// s being GGX, T what a Dielectric transmits, and `diffuse` a lobe that may be on both sides. Layers weigh
/// each other as the extensions say: the coat takes its Fresnel share at the angle of wo (so that it is not
/// reciprocal), sheen the larger of its directional albedos. Only what is above the surface counts for coat,
/// sheen and reflection.
///
/// Microfacets scatter once; with a compensation (make_compensated()) those of the base as often as they meet
/// facets, as in MetallicRoughness and Dielectric, anisotropic ones by the mean of their slopes' variances.
/// The coat's never do: what it reflects is 4%.
struct Layered {
  float metallic;
  Rgb metal_f0;                     // base colour
  DiffuseTransmissionLobe diffuse;  // shares of light, without metallic and Fresnel
  float transmission;               // of the dielectric
  Dielectric dielectric;            // transmits; reflects with the facets below
  AnisotropicGgx facets;
  Vec2f tangent{1, 0};  // cosine and sine of the angle from the frame's x to the facets' x
  float iridescence = 0, film_ior = 1, film_thickness = 0;  // KHR_materials_iridescence; nanometres
  Sheen sheen{{0, 0, 0}, 1};
  float coat = 0;  // weight
  Ggx coat_ggx{1};
  Vec3f coat_normal{0, 0, 1};  // in the shading frame
  std::optional<Compensation> compensation = {};

  /// Whether light may come from beyond the surface.
  bool transmits() const { return transmission > 0 || !is_black(diffuse.transmitted); }

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const;
  std::optional<BsdfSample> sample(const Vec3f& wo, float u1, const Vec2f& u2) const;

  /// Reflectance of a base facet at an angle of that cosine, as a dielectric and as a metal.
  struct Reflectance {
    Rgb dielectric, metal;
  };
  Reflectance reflectance(float cosine) const;

 private:
  enum Part { kCoat, kSheen, kFacets, kBounces, kDiffuse, kTransmission, kParts };
  /// The probabilities with which sample() takes each part: by about what it reflects, none of those that
  /// are there below some percent.
  std::array<float, kParts> shares(const Vec3f& wo) const;
  BsdfValue eval(const Vec3f& wo, const Vec3f& wi, const std::array<float, kParts>& share) const;
  std::optional<Vec3f> sample_part(Part part, const Vec3f& wo, float u1, const Vec2f& u2) const;

  Vec3f to_facets(const Vec3f& w) const {
    return {tangent.x * w.x + tangent.y * w.y, tangent.x * w.y - tangent.y * w.x, w.z};
  }
  float coat_reflectance(const Vec3f& wo) const {
    return coat * (0.04f + 0.96f * schlick_weight(std::abs(wo.dot(coat_normal))));
  }
};
static_assert(Lobe<Layered>);

/// The same surface with the multiple scattering of its base.
Layered make_compensated(Layered lobe);

}  // namespace parian
