/// The BSDF of a surface: one of the lobe types, in the shading frame of the surface, for directions in world
/// space.
#pragma once

#include <variant>

#include "materials/conductor.h"
#include "materials/dielectric.h"
#include "materials/lambert.h"
#include "materials/layered.h"
#include "materials/metallic_roughness.h"
#include "materials/phong.h"
#include "materials/subsurface_exit.h"
#include "renderer/scene/surface.h"

namespace parian {

/// Directions are unit, in world space, away from the surface. A direction that shading and geometric normal
/// put on different sides is black: light would leak through the surface. Where a normal map pretends bumps
/// they shadow each other (bump_shadowing()), at wi alone: there the BSDF is not reciprocal. Radiance that is
/// transmitted is basic radiance (dielectric.h).
class Bsdf {
 public:
  using AnyLobe =
      std::variant<Lambert, MetallicRoughness, Phong, Conductor, Dielectric, Layered, SubsurfaceExit>;

  /// The surface must outlive the BSDF.
  Bsdf(const Surface& surface, const AnyLobe& lobe) : surface_(surface), lobe_(lobe) {}
  Bsdf(Surface&&, const AnyLobe&) = delete;

  /// f |cos wi| with the cosine to the shading normal, and the density per solid angle with which sample()
  /// finds wi.
  BsdfValue eval(const Vec3f& wi) const {
    if (leaks(wi)) return {};
    // The cheapest lobe in place: beside it the choice between the others, and the coordinates that it does
    // not look at, would be felt.
    const auto* lambert = std::get_if<Lambert>(&lobe_);
    if (lambert && !surface_.bumpy) return lambert->eval(to_local(surface_.wo), to_local(wi));
    return eval_lobe(wi);
  }

  // Lambert in place here too, which the compiler does not where there are several calls.
  [[gnu::always_inline]] std::optional<BsdfSample> sample(float u1, const Vec2f& u2) const {
    const auto* lambert = std::get_if<Lambert>(&lobe_);
    std::optional<BsdfSample> s =
        lambert ? lambert->sample(to_local(surface_.wo), u1, u2) : sample_lobe(u1, u2);
    if (!s) return s;
    s->wi = surface_.frame.to_world(s->wi);
    if (leaks(s->wi) || (surface_.bumpy && !shadow(*s))) return std::nullopt;
    return s;
  }

  /// Whether sample() looks at its first number.
  bool has_choice() const { return !std::holds_alternative<Lambert>(lobe_); }

  /// The weight of every sample, where it is one for all directions, or nullptr.
  const Rgb* constant_weight() const {
    const auto* lambert = std::get_if<Lambert>(&lobe_);
    return lambert && !surface_.bumpy ? &lambert->albedo : nullptr;
  }

  /// Whether light may come from beyond the surface.
  bool transmits() const {
    if (std::holds_alternative<Lambert>(lobe_)) return false;  // the most frequent first
    if (const auto* layered = std::get_if<Layered>(&lobe_)) return layered->transmits();
    return std::holds_alternative<Dielectric>(lobe_);
  }

  /// Whether w is on the side of the surface that wo is not on.
  bool beyond(const Vec3f& w) const { return (surface_.front ? w : -w).dot(surface_.ng) <= 0; }

 private:
  BsdfValue eval_lobe(const Vec3f& wi) const;
  bool shadow(BsdfSample& s) const;  // by bumps; false where nothing is left
  std::optional<BsdfSample> sample_lobe(float u1, const Vec2f& u2) const;  // in the shading frame
  Vec3f to_local(const Vec3f& w) const { return surface_.frame.to_local(w); }
  /// Whether shading and geometric normal disagree about the side that w is on.
  bool leaks(const Vec3f& w) const {
    // What leaves from the curved surface has its horizon.
    if (surface_.lifted && w.dot(surface_.frame.z) > 0) return false;
    if (!beyond(w)) return transmits() && w.dot(surface_.frame.z) < 0;
    return !transmits() || w.dot(surface_.frame.z) >= 0;
  }

  const Surface& surface_;
  AnyLobe lobe_;
};

/// Whether light that meets more than one facet of a rough surface is lost, as in glTF's formulas, or comes
/// back (FacetBounces, Dielectric).
enum class Microfacets : std::uint8_t { compensated, single };

/// The BSDF at a surface, its textures looked up. `eta`: where the surface bounds a medium, the index of
/// refraction beyond it over that on the viewer's side.
Bsdf make_bsdf(const Scene& scene, const Surface& surface, Microfacets microfacets, float eta = 1);

/// The base colour at a surface, texture and vertex colour included.
Rgb eval_base_color(const Scene& scene, const Surface& surface);

/// What light is multiplied by as it goes through a surface into a body or out of it: the base colour, of
/// KHR_materials_diffuse_transmission its own.
Rgb eval_crossing_tint(const Scene& scene, const Surface& surface);

/// The share of light from all directions that the surface reflects, roughly: base colour, plus what the coat
/// reflects at normal incidence; of Phong both its terms, of a conductor what it reflects there. For the
/// albedo layer.
Rgb estimate_albedo(const Scene& scene, const Surface& surface);

}  // namespace parian
