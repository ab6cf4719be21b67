#include "scene_io/gltf/pose/influence.h"

#include "renderer/base/parallel.h"

namespace parian {
namespace {

class InfluenceReader {
 public:
  InfluenceReader(const GltfDocument& document, AccessorReader& accessors, const tinygltf::Primitive& source,
                  std::size_t joints, std::size_t vertices, const std::string& where)
      : document_(document),
        accessors_(accessors),
        source_(source),
        joints_(joints),
        vertices_(vertices),
        where_(where) {}

  std::vector<Influences> read() {
    std::vector<Influences> sets;
    for (int n = 0;; ++n) {
      const std::string joints = fmt::format("JOINTS_{}", n), weights = fmt::format("WEIGHTS_{}", n);
      if (n > 0 && !source_.attributes.contains(joints) && !source_.attributes.contains(weights)) return sets;
      sets.push_back({read(joints, false), read(weights, true)});
      check(sets.back(), joints, weights);
    }
  }

 private:
  SharedArray<Vec4f> read(const std::string& name, bool weights) {
    const std::string place = fmt::format("{}/attributes/{}", where_, name);
    const auto found = source_.attributes.find(name);
    if (found == source_.attributes.end())
      document_.fail(place, "expected an accessor, since a node draws the mesh with a skin");
    const auto& accessor = document_.model.accessors[std::size_t(found->second)];
    const bool is_integer = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                            accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
    const bool fits = is_integer ? accessor.normalized == weights
                                 : weights && accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT;
    if (accessor.type != TINYGLTF_TYPE_VEC4 || !fits) {
      document_.fail(place, weights ? "expected an accessor of VEC4, float or normalized unsigned 8 or 16 bit"
                                    : "expected an accessor of VEC4, unsigned 8 or 16 bit");
    }
    // A float holds every joint number of 16 bits.
    auto values = accessors_.vectors<Vec4f>(
        found->second, {.normalized_integers = weights, .plain_integers = !weights}, place);
    if (values.size() != vertices_) {
      document_.fail(place, fmt::format("expected {} elements, as many as POSITION has, not {}", vertices_,
                                        values.size()));
    }
    return values;
  }

  void check(const Influences& set, const std::string& joints, const std::string& weights) const {
    parallel_chunks(vertices_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        for (int c = 0; c < 4; ++c) {
          if (set.joints[i][c] >= float(joints_)) {
            document_.fail(fmt::format("{}/attributes/{}", where_, joints),
                           fmt::format("expected joints below {}, the number in the skin; vertex {} has {}",
                                       joints_, i, set.joints[i][c]));
          }
          if (set.weights[i][c] < 0) {
            document_.fail(
                fmt::format("{}/attributes/{}", where_, weights),
                fmt::format("expected no negative weights; vertex {} has {}", i, set.weights[i][c]));
          }
        }
      }
    });
  }

  const GltfDocument& document_;
  AccessorReader& accessors_;
  const tinygltf::Primitive& source_;
  std::size_t joints_, vertices_;
  const std::string& where_;
};

}  // namespace

std::vector<Influences> read_influences(const GltfDocument& document, AccessorReader& accessors,
                                        const tinygltf::Primitive& source, std::size_t joints,
                                        std::size_t vertices, const std::string& where) {
  return InfluenceReader(document, accessors, source, joints, vertices, where).read();
}

}  // namespace parian
