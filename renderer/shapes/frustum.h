/// The capped frustum of a cone about the origin, along y: a cylinder where its radii are equal, a cone where
/// one of them is 0. Pure functions; lines are intersected in double precision (see sphere.h).
#pragma once

#include <optional>

#include "renderer/shapes/chord.h"

namespace parian {

struct Frustum {
  float radius_bottom, radius_top;  // at y = -height / 2 and height / 2; >= 0, not both 0
  float height;                     // > 0
  bool operator==(const Frustum&) const = default;
};

/// The crossings of the line o + t d, d not zero and of any length; nothing where it misses or touches. The
/// part of the line between the caps' planes is cut by the part inside the cone, whose quadratic is set up at
/// the point of closest approach to the centre, so that its numbers are of the size of the solid.
std::optional<Chord> intersect(const Frustum& f, const Vec3d& o, const Vec3d& d);

/// The point of that face next to p, or one of them.
Vec3f project(const Frustum& f, const Vec3d& p, Face face);

/// On the side u runs as on the sphere, and v is 0 at the top rim and 1 at the bottom rim. A cap is the disk
/// inscribed in the unit square, as seen from outside with +x to the right: -z up on the top one, +z up on
/// the bottom one. At an apex the normal is along the axis.
SolidPoint surface_point(const Frustum& f, const Vec3f& p, Face face);

/// The bounds of the image of the solid, in the axes of the image, about the image of the origin.
Box3d extent(const Frustum& f, const Affine& map);

float area(const Frustum& f);  // caps included
/// Of the image of the solid, to .1%.
double area(const Frustum& f, const Affine& map);
/// Uniform; density 1 / area per area.
SurfaceSample sample_surface(const Frustum& f, const Vec2f& u);

}  // namespace parian
