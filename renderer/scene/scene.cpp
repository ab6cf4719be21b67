#include "renderer/scene/scene.h"

#include <algorithm>
#include <iterator>
#include <span>

#include "renderer/scene/texel_source.h"

namespace parian {
namespace {

void shift(int& index, std::size_t by) {
  if (index != kNone) index += int(by);
}

template <class T>
void extend(std::vector<T>& target, const std::vector<T>& source) {
  target.insert(target.end(), source.begin(), source.end());
}

/// Row y of the image; `storage` holds it where it is not in memory.
std::span<const std::byte> row_of(const Image& image, int y, std::vector<std::byte>& storage) {
  const std::size_t bytes = image.width * pixel_bytes(image);
  if (!image.source) return {image.pixels.data() + bytes * y, bytes};
  std::vector<Vec2i> places;
  for (int x = 0; x < image.width; ++x) places.emplace_back(x, y);
  storage.resize(bytes);
  image.source->fetch(places, storage.data());
  return storage;
}

}  // namespace

std::size_t pixel_bytes(const Image& image) {
  const int bytes = image.type == PixelType::u8 ? 1 : image.type == PixelType::f32 ? 4 : 2;
  return std::size_t(image.channels) * bytes;
}

std::size_t image_bytes(const Image& image) {
  return std::size_t(image.width) * image.height * pixel_bytes(image);
}

bool Image::operator==(const Image& other) const {
  if (name != other.name || width != other.width || height != other.height || channels != other.channels ||
      type != other.type)
    return false;
  if (source == other.source) return pixels == other.pixels;
  std::vector<std::byte> a, b;
  for (int y = 0; y < height; ++y)
    if (!std::ranges::equal(row_of(*this, y, a), row_of(other, y, b))) return false;
  return true;
}

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
