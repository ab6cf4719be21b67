/// Small scenes for tests, as plain data.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian {

/// One flat triangle, front where a, b, c run counter-clockwise.
inline Primitive make_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  Primitive p;
  p.positions = std::vector<Vec3f>{a, b, c};
  p.triangles = std::vector<Triangle>{{0, 1, 2}};
  return p;
}

/// The parallelogram center +- x +- y, flat, its front towards x cross y. uv (0, 0) at -x +y, (1, 1) at +x
/// -y.
inline Primitive make_quad(const Vec3f& center, const Vec3f& x, const Vec3f& y) {
  Primitive p;
  p.positions = std::vector<Vec3f>{center - x - y, center + x - y, center + x + y, center - x + y};
  p.uvs[0] = std::vector<Vec2f>{{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  p.triangles = std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}};
  return p;
}

/// A box, flat, its front outwards (`outwards` false: inwards).
inline Primitive make_box(const Vec3f& min, const Vec3f& max, bool outwards = true) {
  Primitive p;
  std::vector<Vec3f> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z);
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c, d] : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    triangles.push_back(outwards ? Triangle{a, b, c} : Triangle{a, c, b});
    triangles.push_back(outwards ? Triangle{a, c, d} : Triangle{a, d, c});
  }
  p.positions = std::move(corners);
  p.triangles = std::move(triangles);
  return p;
}

/// A sphere of `rings` x 2 `rings` quads around the y axis with smooth normals, its front outwards. u runs
/// around from -x, v from the top. Flat triangles lie inside the sphere: its area is short by about 3 /
/// rings^2.
inline Primitive make_uv_sphere(const Vec3f& center, float radius, int rings) {
  const int sectors = 2 * rings;
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i <= sectors; ++i) {
      const double theta = std::numbers::pi * j / rings, phi = 2 * std::numbers::pi * i / sectors;
      const Vec3f n(
          Vec3d(-std::sin(theta) * std::cos(phi), std::cos(theta), -std::sin(theta) * std::sin(phi)));
      normals.push_back(n);
      positions.push_back(center + n * radius);
      uvs.emplace_back(float(i) / float(sectors), float(j) / float(rings));
    }
  std::vector<Triangle> triangles;
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < sectors; ++i) {
      const auto a = std::uint32_t(j * (sectors + 1) + i), b = a + 1, c = a + std::uint32_t(sectors) + 1,
                 d = c + 1;
      if (j > 0) triangles.push_back({a, b, d});
      if (j + 1 < rings) triangles.push_back({a, d, c});
    }
  Primitive p;
  p.positions = std::move(positions);
  p.normals = std::move(normals);
  p.uvs[0] = std::move(uvs);
  p.triangles = std::move(triangles);
  return p;
}

/// Adds a material and returns its index.
inline int add_material(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return int(scene.materials.size()) - 1;
}

/// A pure Lambert material.
inline Material make_lambert(const Rgb& albedo) {
  Material m;
  m.base_color = albedo;
  m.metallic = 0;
  m.specular = 0;
  return m;
}

/// A black material that emits.
inline Material make_emitter(const Rgb& radiance) {
  Material m = make_lambert({0, 0, 0});
  m.emission = radiance;
  return m;
}

/// Adds a root node and returns its index.
inline int add_root(Scene& scene, Node node) {
  scene.nodes.push_back(std::move(node));
  scene.roots.push_back(int(scene.nodes.size()) - 1);
  return scene.roots.back();
}

/// Adds a mesh of one primitive of the material and a root node that shows it; returns the node's index.
inline int add_mesh(Scene& scene, Primitive primitive, int material, const Transform& transform = {}) {
  primitive.material = material;
  scene.meshes.push_back({"", {std::move(primitive)}});
  Node node;
  node.mesh = int(scene.meshes.size()) - 1;
  node.transform = transform;
  return add_root(scene, node);
}

/// Adds a shape and a root node that shows it with the material; returns the node's index.
inline int add_shape(Scene& scene, Shape shape, int material, const Transform& transform = {}) {
  scene.shapes.push_back(std::move(shape));
  Node node;
  node.shape = int(scene.shapes.size()) - 1;
  node.shape_material = material;
  node.transform = transform;
  return add_root(scene, node);
}

inline Shape make_sphere(float radius) {
  Shape s;
  s.radius = radius;
  return s;
}

inline Shape make_cylinder(float radius_bottom, float radius_top, float height) {
  Shape s;
  s.kind = ShapeKind::cylinder;
  s.radius_bottom = radius_bottom;
  s.radius_top = radius_top;
  s.height = height;
  return s;
}

/// A box, or a plane of sides size.x and size.z.
inline Shape make_flat_shape(ShapeKind kind, const Vec3f& size) {
  Shape s;
  s.kind = kind;
  s.size = size;
  return s;
}

/// Adds a light and a root node that holds it; returns the node's index.
inline int add_light(Scene& scene, Light light, const Transform& transform = {}) {
  scene.lights.push_back(std::move(light));
  Node node;
  node.light = int(scene.lights.size()) - 1;
  node.transform = transform;
  return add_root(scene, node);
}

/// Adds a camera and a root node that holds it; returns the node's index.
inline int add_camera(Scene& scene, Camera camera, const Transform& transform = {}) {
  scene.cameras.push_back(std::move(camera));
  Node node;
  node.camera = int(scene.cameras.size()) - 1;
  node.transform = transform;
  return add_root(scene, node);
}

inline Transform translate(const Vec3f& by) {
  Transform t;
  t.translation = by;
  return t;
}

inline Transform scale(const Vec3f& by) {
  Transform t;
  t.scale = by;
  return t;
}

/// Instances at these places.
inline SharedArray<InstanceTransform> instances(const std::vector<Transform>& places) {
  std::vector<InstanceTransform> result;
  for (const Transform& t : places) result.push_back({t.translation, t.rotation, t.scale});
  return result;
}

/// Turns -z, where cameras and lights look, to the unit vector `direction`, and keeps y up where it can.
inline Transform look_along(const Vec3f& origin, const Vec3f& direction) {
  const Vec3f up = std::abs(direction.y) > 0.99f ? Vec3f(0, 0, 1) : Vec3f(0, 1, 0);
  const Vec3f z = -direction, x = up.cross(z).normalized(), y = z.cross(x);
  Transform t;
  t.matrix =
      Imath::M44f(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1);
  return t;
}

/// An image of the values as they are: T is std::uint8_t, std::uint16_t, Imath::half or float, and says so in
/// `type`.
template <class T>
Image make_image(int width, int height, int channels, PixelType type, const std::vector<T>& values) {
  std::vector<std::byte> bytes(values.size() * sizeof(T));
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return {"test image", width, height, channels, type, std::move(bytes)};
}

/// Adds an image and a texture of it that repeats and is filtered; returns what a material needs to use it.
inline TextureRef add_texture(Scene& scene, Image image, Texture sampler = {}) {
  scene.images.push_back(std::move(image));
  sampler.image = int(scene.images.size()) - 1;
  scene.textures.push_back(sampler);
  TextureRef ref;
  ref.texture = int(scene.textures.size()) - 1;
  return ref;
}

}  // namespace parian
