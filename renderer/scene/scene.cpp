#include "renderer/scene/scene.h"

#include <algorithm>
#include <iterator>
#include <span>

namespace parian {
namespace {

void shift(int& index, std::size_t by) {
  if (index != kNone) index += int(by);
}

template <class T>
void extend(std::vector<T>& target, const std::vector<T>& source) {
  target.insert(target.end(), source.begin(), source.end());
}

}  // namespace

Mat4d InstanceTransform::to_matrix() const {
  // The rows are the images of the axes: those of the rotation matrix of a unit quaternion, times the scale.
  const double length = std::sqrt(double(rotation.r) * rotation.r + Vec3d(rotation.v).dot(Vec3d(rotation.v)));
  const double w = rotation.r / length;
  const Vec3d q = Vec3d(rotation.v) / length;
  const Vec3d s(scale), t(translation);
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = w * q.x, wy = w * q.y, wz = w * q.z;
  return {s.x * (1 - 2 * (yy + zz)),
          s.x * 2 * (xy + wz),
          s.x * 2 * (xz - wy),
          0,
          s.y * 2 * (xy - wz),
          s.y * (1 - 2 * (xx + zz)),
          s.y * 2 * (yz + wx),
          0,
          s.z * 2 * (xz + wy),
          s.z * 2 * (yz - wx),
          s.z * (1 - 2 * (xx + yy)),
          0,
          t.x,
          t.y,
          t.z,
          1};
}

Mat4d Transform::to_matrix() const {
  return matrix ? Mat4d(*matrix) : InstanceTransform{translation, rotation, scale}.to_matrix();
}

void append(Scene& scene, const Scene& other) {
  const std::size_t nodes = scene.nodes.size(), meshes = scene.meshes.size(), shapes = scene.shapes.size(),
                    materials = scene.materials.size(), textures = scene.textures.size(),
                    images = scene.images.size(), cameras = scene.cameras.size(),
                    lights = scene.lights.size();
  // A copy first: `other` may be `scene` itself. It shares all arrays.
  Scene added = other;
  for (Node& node : added.nodes) {
    for (int& child : node.children) shift(child, nodes);
    shift(node.mesh, meshes);
    shift(node.shape, shapes);
    shift(node.shape_material, materials);
    shift(node.camera, cameras);
    shift(node.light, lights);
  }
  for (int& root : added.roots) shift(root, nodes);
  for (Mesh& mesh : added.meshes) {
    for (Primitive& primitive : mesh.primitives) shift(primitive.material, materials);
  }
  for (Material& material : added.materials)
    for_each_texture(material, [&](TextureRef& use) { shift(use.texture, textures); });
  for (Texture& texture : added.textures) shift(texture.image, images);
  shift(added.environment.image, images);

  extend(scene.nodes, added.nodes);
  extend(scene.roots, added.roots);
  extend(scene.meshes, added.meshes);
  extend(scene.shapes, added.shapes);
  extend(scene.materials, added.materials);
  extend(scene.textures, added.textures);
  extend(scene.images, added.images);
  extend(scene.cameras, added.cameras);
  extend(scene.lights, added.lights);
  if (is_black(scene.environment.radiance)) scene.environment = added.environment;
}

}  // namespace parian
