/// read_triangles() and the repair of directions that come with a mesh.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <memory>

#include "renderer/base/parallel.h"
#include "scene_io/gltf/read.h"

namespace parian {
namespace {

// Within what rounding to float leaves, nothing needs to be rewritten (and nothing needs more memory).
constexpr float kUnitTolerance = 1e-5f;

bool is_unit(float squared_length) { return std::abs(squared_length - 1) < kUnitTolerance; }

/// v at unit length in double, so that tiny and huge vectors keep their direction; zero stays zero.
Vec3f to_unit(const Vec3f& v) {
  const Vec3d d(v);
  const double length = std::sqrt(d.dot(d));
  return length > 0 ? Vec3f(d / length) : Vec3f(0);
}

/// The vertices of triangle t of a strip or fan (glTF 2.0, section 3.7.2.1), every other one of a strip
/// turned.
Triangle corners(int mode, std::uint32_t t) {
  if (mode == TINYGLTF_MODE_TRIANGLE_FAN) return {t + 1, t + 2, 0};
  if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) return {t, t + 1 + t % 2, t + 2 - t % 2};
  return {3 * t, 3 * t + 1, 3 * t + 2};
}

/// Normals of the triangles' planes for the vertices in `missing`.
void set_from_triangles(Vec3f* normals, const std::vector<bool>& missing, const Primitive& primitive) {
  std::vector<bool> open = missing;
  for (const Triangle& t : primitive.triangles) {
    if (!open[t[0]] && !open[t[1]] && !open[t[2]]) continue;
    const Vec3d p0(primitive.positions[t[0]]), p1(primitive.positions[t[1]]), p2(primitive.positions[t[2]]);
    const Vec3d cross = (p1 - p0).cross(p2 - p0);
    const double length = std::sqrt(cross.dot(cross));
    if (!(length > 0)) continue;
    for (const std::uint32_t v : t) {
      if (open[v]) normals[v] = Vec3f(cross / length);
      open[v] = false;
    }
  }
}

}  // namespace

SharedArray<Triangle> read_triangles(AccessorReader& accessors, const GltfDocument& document, int indices,
                                     int mode, std::size_t vertices, const std::string& where) {
  const bool indexed = indices >= 0;
  const SharedArray<std::uint32_t> index =
      indexed ? accessors.indices(indices, vertices, where + "/indices") : SharedArray<std::uint32_t>();
  const std::size_t count = indexed ? index.size() : vertices;
  const bool is_list = mode != TINYGLTF_MODE_TRIANGLE_FAN && mode != TINYGLTF_MODE_TRIANGLE_STRIP;
  if (count < 3 || (is_list && count % 3 != 0) || count > std::numeric_limits<std::uint32_t>::max()) {
    document.fail(where, fmt::format("expected {}, not {} vertices or indices",
                                     is_list ? "a multiple of 3" : "at least 3", count));
  }
  const std::size_t triangles = is_list ? count / 3 : count - 2;
  // The indices of a list are triangles already; an index array that primitives share stays shared.
  if (is_list && indexed) {
    const auto owner = std::make_shared<const SharedArray<std::uint32_t>>(index);
    static_assert(sizeof(Triangle) == 3 * sizeof(std::uint32_t));
    return {owner, reinterpret_cast<const Triangle*>(index.data()), triangles};
  }
  accessors.claim(triangles * sizeof(Triangle), where);
  const auto owner = std::make_shared_for_overwrite<Triangle[]>(triangles);
  Triangle* const out = owner.get();
  parallel_chunks(triangles, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      out[t] = corners(mode, std::uint32_t(t));
      if (indexed) out[t] = {index[out[t][0]], index[out[t][1]], index[out[t][2]]};
    }
  });
  return {owner, out, triangles};
}

SharedArray<Vec3f> unit_normals(SharedArray<Vec3f> normals, const Primitive& primitive) {
  if (std::ranges::all_of(normals, [](const Vec3f& n) { return is_unit(n.dot(n)); })) return normals;
  std::vector<Vec3f> units(normals.begin(), normals.end());
  std::vector<bool> missing(units.size(), false);
  bool any_missing = false;
  for (std::size_t i = 0; i < units.size(); ++i) {
    units[i] = to_unit(units[i]);
    missing[i] = units[i] == Vec3f(0);
    any_missing |= missing[i];
    if (missing[i]) units[i] = Vec3f(0, 0, 1);  // where no triangle has an area either
  }
  if (any_missing) set_from_triangles(units.data(), missing, primitive);
  return units;
}

SharedArray<Vec4f> unit_tangents(SharedArray<Vec4f> tangents, const Primitive& primitive) {
  const auto xyz = [](const Vec4f& t) { return Vec3f(t.x, t.y, t.z); };
  const auto is_good = [&](const Vec4f& t) { return is_unit(xyz(t).dot(xyz(t))) && std::abs(t.w) == 1; };
  if (std::ranges::all_of(tangents, is_good)) return tangents;
  std::vector<Vec4f> units(tangents.begin(), tangents.end());
  for (std::size_t i = 0; i < units.size(); ++i) {
    Vec3f direction = to_unit(xyz(units[i]));
    if (direction == Vec3f(0)) direction = make_frame(primitive.normals[i]).x;
    units[i] = Vec4f(direction.x, direction.y, direction.z, units[i].w < 0 ? -1.0f : 1.0f);
  }
  return units;
}

}  // namespace parian
