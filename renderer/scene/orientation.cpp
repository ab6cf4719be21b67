#include "renderer/scene/orientation.h"

#include "renderer/base/parallel.h"

namespace parian {
namespace {

struct Sums {
  Vec3d area_vector{0, 0, 0};
  double area = 0, volume = 0;

  void operator+=(const Sums& other) {
    area_vector += other.area_vector;
    area += other.area;
    volume += other.volume;
  }
};

/// Of the tetrahedra between triangles and `centre`; the area twice, the volume six times.
Sums sum(const Primitive& primitive, const Vec3d& centre) {
  std::vector<Sums> parts(primitive.triangles.size() / kParallelChunk + 1);
  parallel_chunks(primitive.triangles.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Triangle& t = primitive.triangles[i];
      const auto vertex = [&](std::size_t k) { return Vec3d(primitive.positions[t[k]]) - centre; };
      const Vec3d a = vertex(0), normal = (vertex(1) - a).cross(vertex(2) - a);
      parts[begin / kParallelChunk] += {normal, normal.length(), a.dot(normal)};
    }
  });
  Sums total;
  for (const Sums& part : parts) total += part;
  return total;
}

}  // namespace

bool is_inside_out(std::span<const Primitive* const> primitives) {
  if (primitives.empty() || primitives[0]->positions.empty()) return false;
  // The areas of a closed surface add up to nothing, as vectors; then its volume is the same from any centre.
  constexpr double kClosed = 1e-3;
  const Vec3d centre(primitives[0]->positions[0]);
  Sums total;
  for (const Primitive* primitive : primitives) total += sum(*primitive, centre);
  return total.area_vector.length() <= kClosed * total.area && total.volume < 0;
}

}  // namespace parian
