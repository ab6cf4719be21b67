/// Shapes and probes for scenes whose pictures have a closed form.
#pragma once

#include <utility>

#include "tests/support/scenes.h"

namespace parian {

/// A tessellated sphere with flat normals: a convex polyhedron.
inline Primitive make_flat_sphere(const Vec3f& center, float radius, int rings) {
  Primitive p = make_uv_sphere(center, radius, rings);
  p.normals = {};
  return p;
}

/// A capped prism of `sides` around the y axis from y = 0 to `height`, flat, its front outwards; a pyramid
/// where the top radius is 0.
inline Primitive make_prism(int sides, float bottom, float top, float height) {
  std::vector<Vec3f> positions{{0, 0, 0}, {0, height, 0}};
  for (int i = 0; i < sides; ++i) {
    const float angle = 2 * kPi * float(i) / float(sides), x = std::cos(angle), z = std::sin(angle);
    positions.emplace_back(x * bottom, 0.0f, z * bottom);
    positions.emplace_back(x * top, height, z * top);
  }
  std::vector<Triangle> triangles;
  for (int i = 0; i < sides; ++i) {
    const auto a = std::uint32_t(2 + 2 * i), b = std::uint32_t(2 + 2 * ((i + 1) % sides));
    triangles.push_back({0, a, b});
    triangles.push_back({a, a + 1, b});
    if (top == 0) continue;
    triangles.push_back({1, b + 1, a + 1});
    triangles.push_back({b, a + 1, b + 1});
  }
  Primitive p;
  p.positions = std::move(positions);
  p.triangles = std::move(triangles);
  return p;
}

/// The same triangles with their front on the other side.
inline Primitive turned(const Primitive& primitive) {
  std::vector<Triangle> triangles(primitive.triangles.begin(), primitive.triangles.end());
  for (Triangle& t : triangles) std::swap(t[1], t[2]);
  Primitive p = primitive;
  p.triangles = std::move(triangles);
  return p;
}

/// Surface area of a primitive.
inline double area_of(const Primitive& p) {
  double area = 0;
  for (const Triangle& t : p.triangles) {
    const Vec3d a(p.positions[t[0]]), b(p.positions[t[1]]), c(p.positions[t[2]]);
    area += 0.5 * (b - a).cross(c - a).length();
  }
  return area;
}

/// A camera without perspective that sees the square of half side `half` around `point`, from `distance`
/// along `normal`.
inline void add_probe(Scene& scene, const Vec3f& point, const Vec3f& normal, float distance, float half) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.xmag = camera.ymag = half;
  add_camera(scene, camera, look_along(point + normal * distance, -normal));
}

/// A perspective camera at `from` that looks at `to`.
inline void add_eye(Scene& scene, const Vec3f& from, const Vec3f& to, float yfov) {
  Camera camera;
  camera.yfov = yfov;
  add_camera(scene, camera, look_along(from, (to - from).normalized()));
}

/// A Lambert square of half side `half` in the plane y = 0, facing up, and a probe of its middle.
inline void add_receiver(Scene& scene, const Rgb& albedo, float half = 0.05f) {
  add_mesh(scene, make_quad({0, 0, 0}, {half, 0, 0}, {0, 0, -half}),
           add_material(scene, make_lambert(albedo)));
  add_probe(scene, {0, 0, 0}, {0, 1, 0}, 0.02f, 1e-4f);
}

inline Light make_area_light(LightKind kind, float radiance, float width, float height = 1) {
  Light light;
  light.kind = kind;
  light.intensity = radiance;
  light.width = width;
  light.height = height;
  return light;
}

}  // namespace parian
