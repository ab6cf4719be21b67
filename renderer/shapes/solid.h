/// Any of the solids: the functions of sphere.h and frustum.h for the one that it is.
#pragma once

#include <variant>

#include "renderer/shapes/frustum.h"
#include "renderer/shapes/sphere.h"

namespace parian {

using Solid = std::variant<Sphere, Frustum>;

inline std::optional<Chord> intersect(const Solid& solid, const Vec3d& o, const Vec3d& d) {
  return std::visit([&](const auto& s) { return intersect(s, o, d); }, solid);
}
inline Vec3f project(const Solid& solid, const Vec3d& p, Face face) {
  return std::visit([&](const auto& s) { return project(s, p, face); }, solid);
}
inline SolidPoint surface_point(const Solid& solid, const Vec3f& p, Face face) {
  return std::visit([&](const auto& s) { return surface_point(s, p, face); }, solid);
}
inline float area(const Solid& solid) {
  return std::visit([](const auto& s) { return area(s); }, solid);
}
inline double area(const Solid& solid, const Affine& map) {
  return std::visit([&](const auto& s) { return area(s, map); }, solid);
}
inline SurfaceSample sample_surface(const Solid& solid, const Vec2f& u) {
  return std::visit([&](const auto& s) { return sample_surface(s, u); }, solid);
}
/// Bounds of the image of the solid, rounded outwards.
inline Box3f bounds(const Solid& solid, const Affine& map) {
  const Box3d box = std::visit([&](const auto& s) { return extent(s, map); }, solid);
  const Vec3d low = Vec3d(map.origin) + box.min, high = Vec3d(map.origin) + box.max;
  const auto down = [](double x) { return std::nextafter(float(x), -kInfinity); };
  const auto up = [](double x) { return std::nextafter(float(x), kInfinity); };
  return {{down(low.x), down(low.y), down(low.z)}, {up(high.x), up(high.y), up(high.z)}};
}

}  // namespace parian
