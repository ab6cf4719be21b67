#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "renderer/base/parallel.h"
#include "renderer/scene/check.h"

namespace parian {
namespace {

constexpr std::size_t kMaxVertices = std::numeric_limits<std::uint32_t>::max();

class MeshValidation {
 public:
  MeshValidation(const Scene& scene, const Check& check) : scene_(scene), check_(check) {}

  /// Every element of the array, in parallel; once for an array that several primitives share in that use.
  template <class T, class Predicate>
  void check_elements(const SharedArray<T>& array, const std::string& where, const char* expected,
                      const Predicate& holds) {
    if (array.empty() || !seen_.insert({array.data(), array.size(), expected}).second) return;
    parallel_chunks(array.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!holds(array[i])) check_.fail(fmt::format("{}/{}", where, i), expected);
      }
    });
  }

  template <class T>
  void check_length(const SharedArray<T>& array, const Primitive& primitive, const std::string& where) const {
    if (array.empty() || array.size() == primitive.positions.size()) return;
    check_.fail(where, fmt::format("expected {} elements, one per vertex, not {}", primitive.positions.size(),
                                   array.size()));
  }

  void check_primitive(const Primitive& p, const std::string& where) {
    check_.index(p.material, scene_.materials.size(), where + "/material");
    if (p.positions.size() > kMaxVertices)
      check_.fail(where + "/positions", "expected fewer than 2^32 vertices");
    check_length(p.normals, p, where + "/normals");
    check_length(p.tangents, p, where + "/tangents");
    check_length(p.colors, p, where + "/colors");
    check_elements(p.positions, where + "/positions", "expected finite numbers", is_finite);
    check_elements(p.normals, where + "/normals", "expected a unit vector", Check::is_unit);
    check_elements(p.tangents, where + "/tangents", "expected a unit vector, and w of 1 or -1",
                   [](const Vec4f& t) {
                     return Check::is_unit({t.x, t.y, t.z}) && std::abs(t.w) == 1;
                   });
    check_elements(p.colors, where + "/colors", "expected finite numbers of at least 0", [](const Vec4f& c) {
      return std::ranges::all_of(std::array{c.x, c.y, c.z, c.w},
                                 [](float x) { return x >= 0 && std::isfinite(x); });
    });
    for (std::size_t set = 0; set < p.uvs.size(); ++set) {
      const std::string place = fmt::format("{}/uvs/{}", where, set);
      check_length(p.uvs[set], p, place);
      check_elements(p.uvs[set], place, "expected finite numbers",
                     [](const Vec2f& uv) { return std::isfinite(uv.x) && std::isfinite(uv.y); });
    }
    check_triangles(p, where + "/triangles");
  }

  // Not check_elements(): two primitives may share triangles but not vertices.
  void check_triangles(const Primitive& p, const std::string& where) {
    const std::size_t vertices = p.positions.size();
    const auto [known, is_new] =
        triangles_for_.try_emplace({p.triangles.data(), p.triangles.size()}, vertices);
    if (!is_new && known->second <= vertices) return;
    known->second = vertices;
    parallel_chunks(p.triangles.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto& [a, b, c] = p.triangles[i];
        if (std::max({a, b, c}) >= vertices) {
          check_.fail(fmt::format("{}/{}", where, i),
                      fmt::format("expected vertices below {}, not {}", vertices, std::max({a, b, c})));
        }
      }
    });
  }

  const Scene& scene_;
  const Check& check_;
  std::set<std::tuple<const void*, std::size_t, std::string_view>> seen_;
  // Triangles, and the number of vertices that they were checked for.
  std::map<std::pair<const void*, std::size_t>, std::size_t> triangles_for_;
};

}  // namespace

void validate_meshes(const Scene& scene, const Check& check) {
  MeshValidation validation(scene, check);
  check.each("meshes", scene.meshes, [&](const Mesh& mesh, const std::string& where) {
    check.each("primitives", mesh.primitives, [&](const Primitive& primitive, const std::string& place) {
      validation.check_primitive(primitive, where + place);
    });
  });
}

}  // namespace parian
