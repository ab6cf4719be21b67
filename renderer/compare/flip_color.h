/// The colour spaces of FLIP (Andersson et al. 2020, sections 4.1 and 4.2). XYZ is divided by that of the
/// screen's white, D65, so that white is (1, 1, 1).
#pragma once

#include <cmath>

#include "renderer/base/math.h"

namespace parian {

/// Linear Rec.709 to relative XYZ: the primaries and white of IEC 61966-2-1, without rounding.
inline Vec3f xyz_from_rgb(const Vec3f& c) {
  constexpr float kX = 23359437, kY = 12288897, kZ = 80288307;
  return {10135552 / kX * c.x + 8788810 / kX * c.y + 4435075 / kX * c.z,
          2613072 / kY * c.x + 8788810 / kY * c.y + 887015 / kY * c.z,
          1425312 / kZ * c.x + 8788810 / kZ * c.y + 70074185 / kZ * c.z};
}

/// The inverse of xyz_from_rgb().
inline Vec3f rgb_from_xyz(const Vec3f& c) {
  return {3.080341988f * c.x - 1.537398969f * c.y - 0.542943019f * c.z,
          -0.921178396f * c.x + 1.875929984f * c.y + 0.045248412f * c.z,
          0.052881293f * c.x - 0.204011206f * c.y + 1.151129913f * c.z};
}

/// CIE L*a*b* of relative XYZ.
inline Vec3f lab_from_xyz(const Vec3f& c) {
  constexpr float kDelta = 6.0f / 29;
  const auto f = [](float t) {
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29;
  };
  const float x = f(c.x), y = f(c.y), z = f(c.z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

/// L*a*b* with the chroma scaled by lightness: what is dark has little colour (Hunt's effect).
inline Vec3f hunt_adjusted(const Vec3f& lab) { return {lab.x, 0.01f * lab.x * lab.y, 0.01f * lab.x * lab.z}; }

/// The HyAB distance of two colours: Euclidean in a* and b*, and the difference of L* added to it.
inline float hyab_distance(const Vec3f& a, const Vec3f& b) {
  const float da = a.y - b.y, db = a.z - b.z;
  return std::abs(a.x - b.x) + std::sqrt(da * da + db * db);
}

}  // namespace parian
