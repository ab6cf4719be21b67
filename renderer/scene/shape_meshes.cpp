#include "renderer/scene/shape_meshes.h"

#include <cassert>

namespace parian {
namespace {

struct Quads {
  std::vector<Vec3f> positions;
  std::vector<Vec2f> uvs;
  std::vector<Triangle> triangles;

  /// The parallelogram center +- right +- up, seen from where right x up points to.
  void add(const Vec3f& center, const Vec3f& right, const Vec3f& up) {
    const auto first = std::uint32_t(positions.size());
    positions.insert(positions.end(),
                     {center - right - up, center + right - up, center + right + up, center - right + up});
    uvs.insert(uvs.end(), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
    triangles.insert(triangles.end(), {{first, first + 1, first + 2}, {first, first + 2, first + 3}});
  }
};

}  // namespace

Primitive make_shape_primitive(const Shape& shape, int material) {
  assert(shape.kind == ShapeKind::box || shape.kind == ShapeKind::plane);
  const Vec3f x(0.5f * shape.size.x, 0, 0), y(0, 0.5f * shape.size.y, 0), z(0, 0, 0.5f * shape.size.z);
  Quads quads;
  if (shape.kind == ShapeKind::plane) {
    quads.add(Vec3f(0), x, -z);
  } else {
    quads.add(z, x, y);
    quads.add(x, -z, y);
    quads.add(-z, -x, y);
    quads.add(-x, z, y);
    quads.add(y, x, -z);
    quads.add(-y, x, z);
  }
  Primitive p;
  p.positions = std::move(quads.positions);
  p.uvs[0] = std::move(quads.uvs);
  p.triangles = std::move(quads.triangles);
  p.material = material;
  return p;
}

}  // namespace parian
