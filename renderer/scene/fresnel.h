/// Reflectance and refraction at a smooth interface, unpolarised. Cosines are to the normal of the interface
/// (a facet's where there are facets), on the side that the light comes from, in [0, 1].
#pragma once

#include <optional>

#include "renderer/base/math.h"

namespace parian {

/// (1 - cosine)^5: how far Schlick's reflectance is on its way from f0 to f90 (Schlick 1994).
inline float schlick_weight(float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f);
  return (m * m) * (m * m) * m;
}

/// eta^2 - sin^2, the square of eta times the refracted cosine; negative at total internal reflection. In
/// double precision: near the critical angle F goes with its square root, so that an error of 1e-7 in the
/// difference would be one of 1e-3 in F.
inline float refracted_cosine2_times_eta2(float cosine, float eta) {
  const double c = cosine, n = eta;
  return float((n - 1) * (n + 1) + c * c);
}

/// Cosine between the refracted ray and the normal on the far side, >= 0; 0 at total internal reflection.
/// eta > 0 is the index of the far side over that of the near side.
inline float refracted_cosine(float cosine, float eta) {
  return std::min(1.0f, std::sqrt(std::max(0.0f, refracted_cosine2_times_eta2(cosine, eta))) / eta);
}

/// Share of the light that an interface between dielectrics reflects; exactly 1 at total internal reflection,
/// exactly 0 where eta is 1. eta > 0 as in refracted_cosine(). Fresnel's equations (Born and Wolf, 1.5.2).
inline float fresnel_dielectric(float cosine, float eta) {
  if (eta == 1) return 0;
  const float q2 = refracted_cosine2_times_eta2(cosine, eta);
  if (q2 <= 0) return 1;
  const float q = std::sqrt(q2), p = eta * eta * cosine;
  const float r_s = (cosine - q) / (cosine + q), r_p = (p - q) / (p + q);
  return 0.5f * (r_s * r_s + r_p * r_p);
}

/// fresnel_dielectric() in double precision throughout, for integrals.
double fresnel_dielectric_exact(double cosine, double eta);

/// The integral of F(mu) mu^k dmu over mu from 0 to 1, F being fresnel_dielectric() from the side of which
/// eta is the relative index, below 1 from inside a dense body. 2 fresnel_moment(eta, 1) is the share of
/// diffuse light that is reflected. To 1e-9; takes microseconds.
double fresnel_moment(double eta, int k);

/// Direction in which light that comes from wo goes on behind an interface with normal h: unit, away from the
/// interface, on the other side of it than wo. Nothing at total internal reflection. wo and h are unit,
/// wo.h >= 0; eta as in refracted_cosine().
inline std::optional<Vec3f> refract(const Vec3f& wo, const Vec3f& h, float eta) {
  const float cosine = wo.dot(h), q2 = refracted_cosine2_times_eta2(cosine, eta);
  if (q2 <= 0) return std::nullopt;
  return (h * (cosine - std::sqrt(q2)) - wo) * (1 / eta);
}

/// Share of the light that a metal of refractive index eta + ik, relative to what is outside, reflects.
/// eta, k >= 0. With k = 0 it is a dielectric; then exactly 1 beyond the critical angle.
///
/// a + ib = sqrt((eta + ik)^2 - sin^2) (Born and Wolf, 14.2). a is the small one of the two where the root's
/// real part is negative, and 2 a^2 = |.| + real part cancels there: 2ab = 2 eta k gives it instead.
inline float fresnel_conductor(float cosine, float eta, float k) {
  const float c2 = cosine * cosine, s2 = (1 - cosine) * (1 + cosine);
  // In double precision for the same reason as above: for small k this is close to a square root at 0. And
  // t^2 would underflow.
  const double n = eta, kd = k, c = cosine, nk = n * kd;
  const double t = (n - 1) * (n + 1) + c * c - kd * kd;
  const float modulus = float(std::sqrt(t * t + 4 * nk * nk));  // a^2 + b^2
  if (!(modulus > 0)) return eta == 1 ? 0 : 1;                  // at the critical angle of a dielectric
  const float root = std::sqrt(0.5f * (modulus + float(std::abs(t))));
  const float a = t >= 0 ? root : float(nk) / root;
  const float ac = 2 * a * cosine, p = c2 * modulus + s2 * s2, p_ac = ac * s2;
  const float r_s = (modulus + c2 - ac) / (modulus + c2 + ac);
  const float r_p = r_s * ((p - p_ac) / (p + p_ac));
  return std::clamp(0.5f * (r_s + r_p), 0.0f, 1.0f);
}

/// The same for each channel.
inline Rgb fresnel_conductor(float cosine, const Rgb& eta, const Rgb& k) {
  return {fresnel_conductor(cosine, eta.x, k.x), fresnel_conductor(cosine, eta.y, k.y),
          fresnel_conductor(cosine, eta.z, k.z)};
}

}  // namespace parian
