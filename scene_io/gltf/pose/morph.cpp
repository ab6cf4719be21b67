/// apply_targets(): vertices moved by the weighted targets of their primitive.
#include <algorithm>
#include <cmath>
#include <memory>

#include "renderer/base/parallel.h"
#include "scene_io/gltf/pose/deform.h"
#include "scene_io/gltf/read.h"

namespace parian {
namespace {

constexpr Components kPosition{.normalized_integers = true, .plain_integers = true};
constexpr Components kNormalized{.normalized_integers = true};

struct Morph {
  const GltfDocument& document;
  AccessorReader& accessors;
  const tinygltf::Primitive& source;
  const std::vector<float>& weights;
  const std::string& where;

  /// Calls body(target's deltas, weight, the accessor's type) for each target that moves the attribute.
  template <class Delta, class Body>
  void for_each(const char* name, Components components, std::size_t vertices, const Body& body) const {
    for (std::size_t t = 0; t < weights.size(); ++t) {
      const auto found = source.targets[t].find(name);
      if (weights[t] == 0 || found == source.targets[t].end()) continue;
      const std::string place = fmt::format("{}/targets/{}/{}", where, t, name);
      if (!source.attributes.contains(name))
        document.fail(place, "expected no such member, since the primitive lacks that attribute");
      const auto deltas = accessors.vectors<Delta>(found->second, components, place);
      if (deltas.size() != vertices) {
        document.fail(place,
                      fmt::format("expected {} elements, as many as the primitive has vertices, not {}",
                                  vertices, deltas.size()));
      }
      // Not for the memory: so that targets and nodes that are cheap to write cannot mean work without end.
      accessors.claim(vertices, place);
      body(deltas, weights[t], document.model.accessors[std::size_t(found->second)].type);
    }
  }

  /// The attribute with its deltas, in an array of its own where there are any, each element then finished.
  /// Of a Vec4f with deltas of three components w stays.
  template <class Delta, class Vector, class Finish>
  void add(const char* name, Components components, SharedArray<Vector>& attribute,
           const Finish& finish) const {
    // It is there, but does not count: tangents without normals.
    if (attribute.empty() && source.attributes.contains(name)) return;
    std::shared_ptr<Vector[]> sums;
    const std::size_t count = attribute.size();
    for_each<Delta>(name, components, count, [&](const SharedArray<Delta>& deltas, float weight, int type) {
      if (!sums) {
        accessors.claim(attribute.bytes(), where);
        sums = std::make_shared_for_overwrite<Vector[]>(count);
        std::copy(attribute.begin(), attribute.end(), sums.get());
      }
      const int moved = tinygltf::GetNumComponentsInType(std::uint32_t(type));
      parallel_chunks(count, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          for (int c = 0; c < moved; ++c) sums[i][c] += weight * deltas[i][c];
      });
    });
    if (!sums) return;
    parallel_chunks(count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        finish(sums[i]);
        for (int c = 0; c < int(Vector::dimensions()); ++c) {
          if (!std::isfinite(sums[i][c]))
            document.fail(where + "/targets", fmt::format("expected a finite {} of vertex {}", name, i));
        }
      }
    });
    attribute = SharedArray<Vector>(sums, sums.get(), count);
  }
};

}  // namespace

std::size_t morph_target_count(const GltfDocument& document, int mesh) {
  if (mesh < 0) return 0;
  const auto& primitives = document.model.meshes[std::size_t(mesh)].primitives;
  const std::size_t count = primitives.empty() ? 0 : primitives.front().targets.size();
  for (std::size_t p = 0; p < primitives.size(); ++p) {
    if (primitives[p].targets.size() != count) {
      document.fail(fmt::format("/meshes/{}/primitives/{}/targets", mesh, p),
                    fmt::format("expected {} targets, as many as the first primitive has, not {}", count,
                                primitives[p].targets.size()));
    }
  }
  return count;
}

void apply_targets(const GltfDocument& document, AccessorReader& accessors, const tinygltf::Primitive& source,
                   const std::vector<float>& weights, const std::string& where, Primitive& primitive) {
  const Morph morph{document, accessors, source, weights, where};
  const auto leave = [](const auto&) {};
  const auto make_unit = [](auto& v) {
    const Vec3f unit = unit_or_zero(Vec3d(v.x, v.y, v.z));
    for (int c = 0; c < 3; ++c) v[c] = unit[c];
  };
  const auto clamp = [](Vec4f& color) {  // as the specification asks
    for (int c = 0; c < 4; ++c) color[c] = std::clamp(color[c], 0.0f, 1.0f);
  };
  morph.add<Vec3f>("POSITION", kPosition, primitive.positions, leave);
  morph.add<Vec3f>("NORMAL", kNormalized, primitive.normals, make_unit);
  morph.add<Vec3f>("TANGENT", kNormalized, primitive.tangents, make_unit);
  morph.add<Vec2f>("TEXCOORD_0", kPosition, primitive.uvs[0], leave);
  morph.add<Vec2f>("TEXCOORD_1", kPosition, primitive.uvs[1], leave);
  morph.add<Vec4f>("COLOR_0", kNormalized, primitive.colors, clamp);
}

}  // namespace parian
