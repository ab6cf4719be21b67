/// Warps of the unit square, their densities, and the weights that combine strategies.
#pragma once

#include <bit>
#include <cstdint>

#include "renderer/base/math.h"

namespace parian {

/// (cos, sin) of 2 pi u for u in [0, 1], to 2e-7: Taylor polynomials on [-pi/4, pi/4] around the nearest
/// quarter turn. A third of the cost of the library's, whose range reduction is for any argument.
inline Vec2f unit_circle(float u) {
  const int quarter = int(4 * u + 0.5f);
  const float x = (u - 0.25f * float(quarter)) * (2 * kPi), x2 = x * x;
  const float s = x * (1 + x2 * (-1.0f / 6 + x2 * (1.0f / 120 + x2 * (-1.0f / 5040 + x2 * (1.0f / 362880)))));
  const float c = 1 + x2 * (-0.5f + x2 * (1.0f / 24 + x2 * (-1.0f / 720 + x2 * (1.0f / 40320))));
  // By bits: which quarter it is is chance, and a branch on chance is mispredicted half the time.
  const std::uint32_t odd = -(std::uint32_t(quarter) & 1), sign = (std::uint32_t(quarter) & 2) << 30;
  const auto bits_s = std::bit_cast<std::uint32_t>(s), bits_c = std::bit_cast<std::uint32_t>(c);
  const std::uint32_t exchange = (bits_s ^ bits_c) & odd;
  return {std::bit_cast<float>(bits_c ^ exchange ^ sign ^ (odd & 0x80000000u)),
          std::bit_cast<float>(bits_s ^ exchange ^ sign)};
}

/// Cosine-distributed direction about +z; density cos / pi per solid angle.
inline Vec3f sample_cosine_hemisphere(const Vec2f& u) {
  const Vec2f p = unit_circle(u.y) * std::sqrt(u.x);
  return {p.x, p.y, std::sqrt(1 - u.x)};
}

/// Uniform point of the unit disk (density 1 / pi per area): r = sqrt(u).
inline Vec2f sample_disk(const Vec2f& u) { return unit_circle(u.y) * std::sqrt(u.x); }

/// Uniform direction; density 1 / (4 pi) per solid angle.
inline Vec3f sample_sphere(const Vec2f& u) {
  const float z = 1 - 2 * u.x;
  const Vec2f p = unit_circle(u.y) * std::sqrt(std::max(0.0f, 1 - z * z));
  return {p.x, p.y, z};
}

/// Barycentric weights (b1, b2) of a uniform point of a triangle (Heitz 2019, A Low-Distortion Map Between
/// Triangle and Square).
inline Vec2f sample_triangle(const Vec2f& u) {
  const float half = 0.5f * std::min(u.x, u.y);
  return {u.x - half, u.y - half};
}

/// Weight of a sample drawn with density a where another strategy has density b: the power heuristic with
/// exponent 2 (Veach 1997, 9.2.4), in the form that neither overflows nor underflows. Both in the same
/// measure; a > 0.
inline float power_heuristic(float a, float b) {
  const float ratio = b / a;
  return 1 / (1 + ratio * ratio);
}

/// power_heuristic(a, b) / a, what a sample of density a is multiplied by; one division less.
inline float power_heuristic_over_pdf(float a, float b) { return 1 / (a + b * (b / a)); }

}  // namespace parian
