/// Vectors, frames, affine maps and rays. Linear algebra is Imath's; what is here is what Imath lacks.
#pragma once

#include <Imath/ImathBox.h>
#include <Imath/ImathColor.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathQuat.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace parian {

using Vec2f = Imath::V2f;
using Vec2i = Imath::V2i;
using Vec3f = Imath::V3f;
using Vec3d = Imath::V3d;
using Vec4f = Imath::V4f;
using Quatf = Imath::Quatf;
using Box3f = Imath::Box3f;
using Box3d = Imath::Box3d;
/// Row-vector convention (p' = p M, translation in row 3), which is the memory order of a glTF matrix.
using Mat4d = Imath::M44d;
/// Linear Rec.709 radiance, reflectance or weight.
using Rgb = Imath::C3f;

inline constexpr float kPi = std::numbers::pi_v<float>;
inline constexpr float kInvPi = std::numbers::inv_pi_v<float>;
inline constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Half the distance from 1 to the next float: the relative error of one rounded operation.
inline constexpr float kUnitRoundoff = std::numeric_limits<float>::epsilon() * 0.5f;
/// Relative error bound after n roundings (Higham, Accuracy and Stability of Numerical Algorithms, 3.1).
constexpr float error_gamma(int n) { return n * kUnitRoundoff / (1 - n * kUnitRoundoff); }

inline Vec3f abs(const Vec3f& v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }
inline Vec3f max(const Vec3f& a, const Vec3f& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
inline float max_component(const Vec3f& v) { return std::max(v.x, std::max(v.y, v.z)); }
/// Unit vector along v; v must not be zero. Without the checks of Imath's normalized().
inline Vec3f normalize(const Vec3f& v) { return v * (1 / std::sqrt(v.dot(v))); }
/// Rec.709 luminance of a linear colour.
inline float luminance(const Rgb& c) { return 0.212639f * c.x + 0.715169f * c.y + 0.072192f * c.z; }
inline bool is_finite(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
/// Of a colour without negative components.
inline bool is_black(const Rgb& c) { return c.x + c.y + c.z == 0; }

/// The angle of the point (x, y) from the x axis, in [-pi, pi], to 4e-7; 0 at the origin. The arc tangent on
/// [0, 1] is a minimax polynomial (fitted by Lawson's iteration, 4e-8); at random points two fifths of the
/// cost of the library's atan2 (11 and 28 ns).
inline float angle_of(float x, float y) {
  const float ax = std::abs(x), ay = std::abs(y);
  const float larger = std::max(ax, ay), smaller = std::min(ax, ay);
  const float t = larger > 0 ? smaller / larger : 0, t2 = t * t;
  float a = -0.0040545566f;
  for (const float c :
       {0.021862921f, -0.055912275f, 0.096421934f, -0.13908628f, 0.19946565f, -0.33329859f, 0.99999934f})
    a = a * t2 + c;
  a *= t;
  if (ay > ax) a = 0.5f * kPi - a;
  if (x < 0) a = kPi - a;
  return std::copysign(a, y);
}

/// An orthonormal basis; `to_local` and `to_world` map directions, z being the normal.
struct Frame {
  Vec3f x, y, z;
  Vec3f to_local(const Vec3f& w) const { return {w.dot(x), w.dot(y), w.dot(z)}; }
  Vec3f to_world(const Vec3f& l) const { return x * l.x + y * l.y + z * l.z; }
};

/// A frame around the unit vector z (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
inline Frame make_frame(const Vec3f& z) {
  const float sign = std::copysign(1.0f, z.z);
  const float a = -1 / (sign + z.z);
  const float b = z.x * z.y * a;
  return {{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}

/// p -> x p.x + y p.y + z p.z + p0: the columns of a 3x4 matrix.
template <class T>
struct BasicAffine {
  using Vec = Imath::Vec3<T>;
  Vec x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};

  Vec point(const Vec& q) const { return x * q.x + y * q.y + z * q.z + origin; }
  Vec vector(const Vec& v) const { return x * v.x + y * v.y + z * v.z; }
  /// The cofactor matrix applied to a normal: the direction of the inverse transpose times |det|, with the
  /// sign of the determinant taken out, so that a mirrored closed surface keeps its outside. Its length is
  /// the factor by which an area across a unit n grows.
  Vec normal(const Vec& n) const {
    const Vec c = y.cross(z) * n.x + z.cross(x) * n.y + x.cross(y) * n.z;
    return determinant() < 0 ? -c : c;
  }
  T determinant() const { return x.dot(y.cross(z)); }
  bool operator==(const BasicAffine&) const = default;
};
using Affine = BasicAffine<float>;
using Affined = BasicAffine<double>;

/// The inverse of a map whose determinant is not zero, in double precision.
inline Affined inverse(const Affine& a) {
  const Vec3d x(a.x), y(a.y), z(a.z);
  // The rows of the inverse are the cofactors over the determinant.
  const double det = x.dot(y.cross(z));
  const Vec3d rx = y.cross(z) / det, ry = z.cross(x) / det, rz = x.cross(y) / det;
  Affined inverse{{rx.x, ry.x, rz.x}, {rx.y, ry.y, rz.y}, {rx.z, ry.z, rz.z}, {0, 0, 0}};
  inverse.origin = -inverse.vector(Vec3d(a.origin));
  return inverse;
}

/// The affine part of a row-vector matrix, rounded to float.
inline Affine to_affine(const Mat4d& m) {
  const auto row = [&](int i) { return Vec3f(float(m[i][0]), float(m[i][1]), float(m[i][2])); };
  return {row(0), row(1), row(2), row(3)};
}

/// A ray from o along d, d of unit length unless said otherwise; hits count in (0, tmax).
struct Ray {
  Vec3f o, d;
  float tmax = kInfinity;
};

}  // namespace parian
