/// The BSDF of a surface: one of the lobe types, in the shading frame of the surface, for directions in world
/// space.
#pragma once

#include <variant>

#include "materials/lambert.h"
#include "materials/metallic_roughness.h"
#include "renderer/scene/surface.h"

namespace parian {

/// Directions are unit, in world space, away from the surface. A direction that shading and geometric normal
/// put on different sides is black: light would leak through the surface.
class Bsdf {
 public:
  using AnyLobe = std::variant<Lambert, MetallicRoughness>;

  Bsdf(const Surface& surface, const AnyLobe& lobe)
      : frame_(surface.frame),
        wo_(surface.frame.to_local(surface.wo)),
        ng_(surface.front ? surface.ng : -surface.ng),
        lobe_(lobe) {}

  /// f |cos wi| with the cosine to the shading normal, and the density per solid angle with which sample()
  /// finds wi.
  BsdfValue eval(const Vec3f& wi) const {
    if (wi.dot(ng_) <= 0) return {};
    const Vec3f local = frame_.to_local(wi);
    return std::visit([&](const auto& lobe) { return lobe.eval(wo_, local); }, lobe_);
  }

  std::optional<BsdfSample> sample(float u1, const Vec2f& u2) const {
    std::optional<BsdfSample> s =
        std::visit([&](const auto& lobe) { return lobe.sample(wo_, u1, u2); }, lobe_);
    if (!s) return s;
    s->wi = frame_.to_world(s->wi);
    if (s->wi.dot(ng_) <= 0) return std::nullopt;
    return s;
  }

  /// Whether sample() looks at its first number.
  bool has_choice() const { return !std::holds_alternative<Lambert>(lobe_); }

 private:
  Frame frame_;
  Vec3f wo_, ng_;
  AnyLobe lobe_;
};

/// The BSDF at a surface, its textures looked up.
Bsdf make_bsdf(const Scene& scene, const Surface& surface);

/// The base colour at a surface, texture and vertex colour included.
Rgb eval_base_color(const Scene& scene, const Surface& surface);

/// The share of light from all directions that the surface reflects, roughly: base colour, plus what the coat
/// reflects at normal incidence. For the albedo layer.
Rgb estimate_albedo(const Scene& scene, const Surface& surface);

}  // namespace parian
