#include "editing/add.h"

#include <algorithm>
#include <utility>

#include "editing/arguments.h"
#include "editing/tree.h"

namespace parian::edit {
namespace {

void check_place(const Scene& scene, const Place& place) {
  check_parent(scene, place.parent);
  check_element(place.transform);
}

/// The place is checked.
int add_node(Scene& scene, Node node, const Place& place) {
  const int made = int(scene.nodes.size());
  node.transform = place.transform;
  scene.nodes.push_back(std::move(node));
  children_of(scene, place.parent).push_back(made);
  return made;
}

const char* name_of(LightKind kind) {
  switch (kind) {
    case LightKind::point:
      return "point light";
    case LightKind::spot:
      return "spot light";
    case LightKind::directional:
      return "directional light";
    case LightKind::rectangle:
      return "rectangle light";
    default:
      return "disk light";
  }
}

Shape named(const char* name, ShapeKind kind) {
  Shape shape;
  shape.name = name;
  shape.kind = kind;
  return shape;
}

}  // namespace

Shape sphere(float radius) {
  Shape shape = named("sphere", ShapeKind::sphere);
  shape.radius = radius;
  return shape;
}

Shape box(const Vec3f& size) {
  Shape shape = named("box", ShapeKind::box);
  shape.size = size;
  return shape;
}

Shape cylinder(float radius, float height) {
  Shape shape = frustum(radius, radius, height);
  shape.name = "cylinder";
  return shape;
}

Shape cone(float radius, float height) {
  Shape shape = frustum(radius, 0, height);
  shape.name = "cone";
  return shape;
}

Shape frustum(float radius_bottom, float radius_top, float height) {
  Shape shape = named("frustum", ShapeKind::cylinder);
  shape.radius_bottom = radius_bottom;
  shape.radius_top = radius_top;
  shape.height = height;
  return shape;
}

Shape plane(float size_x, float size_z) {
  Shape shape = named("plane", ShapeKind::plane);
  shape.size = {size_x, 1, size_z};
  return shape;
}

int add_shape(Scene& scene, const Shape& shape, const Place& place, int material) {
  check_place(scene, place);
  check_element(shape);
  if (material != kNone) check_index(material, scene.materials.size(), "material");
  if (material == kNone) {
    material = int(scene.materials.size());
    scene.materials.emplace_back().name = shape.name;
    scene.materials.back().metallic = 0;
  }
  Node node;
  node.name = shape.name;
  node.shape = int(scene.shapes.size());
  node.shape_material = material;
  scene.shapes.push_back(shape);
  return add_node(scene, std::move(node), place);
}

Light default_light(LightKind kind) {
  Light light;
  light.name = name_of(kind);
  light.kind = kind;
  return light;
}

int add_light(Scene& scene, const Light& light, const Place& place) {
  check_place(scene, place);
  check_element(light);
  Node node;
  node.name = light.name;
  node.light = int(scene.lights.size());
  scene.lights.push_back(light);
  return add_node(scene, std::move(node), place);
}

int add_camera(Scene& scene, const Camera& camera, const Place& place) {
  check_place(scene, place);
  check_element(camera);
  Node node;
  node.name = camera.name;
  node.camera = int(scene.cameras.size());
  scene.cameras.push_back(camera);
  return add_node(scene, std::move(node), place);
}

int add_camera_from_view(Scene& scene, const Camera& camera, const Vec3f& eye, const Vec3f& target,
                         const Vec3f& up) {
  const Vec3d back = Vec3d(eye) - Vec3d(target);
  if (!is_finite(eye) || !is_finite(target) || !(back.length() > 0))
    refuse("camera: expected an eye and a target that are finite and apart, in metres");
  if (!is_finite(up)) refuse("camera: expected an up vector of finite numbers");
  const Vec3d z = back.normalized();
  Vec3d x = Vec3d(up).cross(z);
  // Up lies along the view: the axis that lies across it most.
  if (x.length() <= 1e-6 * Vec3d(up).length())
    x = (std::abs(z.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1)).cross(z);
  x.normalize();
  const Vec3d y = z.cross(x), o(eye);
  const Mat4d matrix(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, o.x, o.y, o.z, 1);
  return add_camera(scene, camera, {kNone, to_transform(matrix)});
}

int add_group(Scene& scene, std::string name, const Place& place) {
  check_place(scene, place);
  Node node;
  node.name = std::move(name);
  return add_node(scene, std::move(node), place);
}

int add_scene(Scene& scene, const Scene& other, std::string name, const Place& place) {
  check_place(scene, place);
  const std::size_t own_roots = scene.roots.size();
  append(scene, other);
  Node node;
  node.name = std::move(name);
  const auto first = scene.roots.begin() + std::ptrdiff_t(own_roots);
  node.children.assign(first, scene.roots.end());
  scene.roots.erase(first, scene.roots.end());
  return add_node(scene, std::move(node), place);
}

}  // namespace parian::edit
