/// The sphere about the origin. All functions are pure; lines are intersected in double precision, which at a
/// distance of 10^5 radii leaves an error of 10^-11 radii where single precision leaves one of a radius.
#pragma once

#include <optional>

#include "renderer/shapes/chord.h"

namespace parian {

struct Sphere {
  float radius;  // > 0
  bool operator==(const Sphere&) const = default;
};

/// The crossings of the line o + t d, d not zero and of any length; nothing where it misses or touches. The
/// discriminant from the distance of the line to the centre, and the roots without a difference of like
/// numbers (Haines et al. 2019, Precision Improvements for Ray/Sphere Intersection; their point of closest
/// approach is d x (o x d) / d.d, and what misses needs no division).
inline std::optional<Chord> intersect(const Sphere& s, const Vec3d& o, const Vec3d& d) {
  const Vec3d across = o.cross(d);
  const double a = d.dot(d), b = -o.dot(d), r2 = double(s.radius) * s.radius;
  const double discriminant = a * r2 - across.dot(across);
  if (!(discriminant > 0)) return std::nullopt;
  const double c = o.dot(o) - r2, q = b + std::copysign(std::sqrt(discriminant), b);
  const double t0 = c / q, t1 = q / a;
  return Chord{{std::min(t0, t1), Face::side}, {std::max(t0, t1), Face::side}};
}

/// The point of the surface next to p; p must not be the centre.
Vec3f project(const Sphere& s, const Vec3d& p, Face face);

/// u = .5 at +z and grows towards +x, its seam at -z; v = 0 at +y.
SolidPoint surface_point(const Sphere& s, const Vec3f& p, Face face);

/// The bounds of the image of the solid, in the axes of the image, about the image of the origin.
Box3d extent(const Sphere& s, const Affine& map);

float area(const Sphere& s);
/// Of the image of the solid, to .1%.
double area(const Sphere& s, const Affine& map);
/// Uniform; density 1 / area per area.
SurfaceSample sample_surface(const Sphere& s, const Vec2f& u);

/// A direction from a point to a sphere.
struct SphereDirection {
  Vec3f w;       // unit
  float pdf;     // per solid angle
  Vec3f normal;  // unit and outwards, where w first meets the sphere
};

/// A direction from p to the sphere of that centre and radius, uniform in the cone of directions that meet it
/// (Wang 1992, Physically Correct Direct Lighting; the cone's size by s^2 / (1 + c), so that it
/// neither cancels far away nor turns to NaN). From inside, and so near to the surface that rounding decides
/// what is inside, uniform over all directions; nothing where such a direction misses.
std::optional<SphereDirection> sample_directions(const Vec3f& center, float radius, const Vec3f& p,
                                                 const Vec2f& u);
/// The density of sample_directions() in every direction that meets the sphere.
float pdf_directions(const Vec3f& center, float radius, const Vec3f& p);

}  // namespace parian
