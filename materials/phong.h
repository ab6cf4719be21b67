/// The modified Phong surface: a diffuse lobe and a power of the cosine to the mirror direction.
#pragma once

#include "materials/lobe.h"
#include "renderer/base/sampling.h"

namespace parian {

/// f = diffuse / pi + specular (n + 2) / (2 pi) cos^n a, where a is the angle between wi and the mirror
/// direction of wo, and the second term is 0 for a >= 90 degrees (Lafortune and Willems 1994, Using the
/// Modified Phong Reflectance Model for Physically Based Rendering). Reciprocal; reflects no more than
/// diffuse + specular, all of it where wo is the normal, and less the flatter the light comes.
struct Phong {
  Rgb diffuse, specular;
  float exponent;  // n >= 0, to about 1e6: beyond, the lobe is narrower than single precision resolves

  BsdfValue eval(const Vec3f& wo, const Vec3f& wi) const {
    if (wi.z <= 0) return {};
    const float power = cos_power(wo, wi), choice = specular_probability(wo);
    const Rgb f = diffuse * kInvPi + specular * ((exponent + 2) * (0.5f * kInvPi) * power);
    return {f * wi.z, choice * ((exponent + 1) * (0.5f * kInvPi) * power) + (1 - choice) * (kInvPi * wi.z)};
  }

  /// Fails for the part of the lobe that is below the horizon.
  std::optional<BsdfSample> sample(const Vec3f& wo, float u1, const Vec2f& u2) const {
    const Vec3f wi = u1 < specular_probability(wo) ? sample_cos_power(wo, u2) : sample_cosine_hemisphere(u2);
    const BsdfValue value = eval(wo, wi);
    if (!(value.pdf > 0)) return std::nullopt;
    return BsdfSample{wi, value.f_cos * (1 / value.pdf), value.pdf};
  }

 private:
  /// cos^n a. 1 - cos a from the chord: the cosine itself is 1 for every angle that matters to a large n.
  float cos_power(const Vec3f& wo, const Vec3f& wi) const {
    const float below_one = 0.5f * (wi - mirror(wo)).length2();
    return below_one < 1 ? std::exp(exponent * std::log1p(-below_one)) : 0;
  }

  /// About the mirror direction, with density (n + 1) / (2 pi) cos^n a per solid angle (ibid.): cos a
  /// is the (n + 1)th root of a uniform number.
  Vec3f sample_cos_power(const Vec3f& wo, const Vec2f& u) const {
    const float below_one = -std::expm1(std::log1p(-u.x) / (exponent + 1));
    const Vec2f p = unit_circle(u.y) * std::sqrt(below_one * (2 - below_one));
    return make_frame(mirror(wo)).to_world({p.x, p.y, 1 - below_one});
  }

  static Vec3f mirror(const Vec3f& wo) { return {-wo.x, -wo.y, wo.z}; }

  /// About the specular share of the reflected light; both components keep a chance. The albedo of the
  /// specular term goes from 1 at the normal to 1 / sqrt(2 pi n) for large n at the horizon; the constant
  /// makes it right for n = 0 too. Within 6% at n of 0, 1, 10 (60 degrees).
  float specular_probability(const Vec3f& wo) const {
    const float albedo = std::min(1.0f, std::sqrt(wo.z * wo.z + 0.5f * kInvPi / (exponent + 2 * kInvPi)));
    const float s = luminance(specular) * albedo, d = luminance(diffuse);
    if (d <= 0) return 1;
    if (s <= 0) return 0;
    return std::clamp(s / (s + d), 0.1f, 0.9f);
  }
};
static_assert(Lobe<Phong>);

}  // namespace parian
