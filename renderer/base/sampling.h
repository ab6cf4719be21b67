/// Warps of the unit square, their densities, and the weights that combine strategies.
#pragma once

#include "renderer/base/math.h"

namespace parian {

/// Cosine-distributed direction about +z; density cos / pi per solid angle.
inline Vec3f sample_cosine_hemisphere(const Vec2f& u) {
  const float r = std::sqrt(u.x), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u.x)};
}

/// Uniform point of the unit disk (density 1 / pi per area): r = sqrt(u).
inline Vec2f sample_disk(const Vec2f& u) {
  const float r = std::sqrt(u.x), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Uniform direction; density 1 / (4 pi) per solid angle.
inline Vec3f sample_sphere(const Vec2f& u) {
  const float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * kPi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Barycentric weights (b1, b2) of a uniform point of a triangle (Heitz 2019, A Low-Distortion Map Between Triangle
/// and Square).
inline Vec2f sample_triangle(const Vec2f& u) {
  return u.y > u.x ? Vec2f(u.x * 0.5f, u.y - u.x * 0.5f) : Vec2f(u.x - u.y * 0.5f, u.y * 0.5f);
}

/// Weight of a sample drawn with density a where another strategy has density b: the power heuristic with exponent 2
/// (Veach 1997, 9.2.4), in the form that neither overflows nor underflows. Both in the same measure; a > 0.
inline float power_heuristic(float a, float b) {
  const float ratio = b / a;
  return 1 / (1 + ratio * ratio);
}

}  // namespace parian
