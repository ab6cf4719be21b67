/// Skins: linear blend skinning, the vertices taken to world space by their joints (glTF 2.0, section 3.7.3).
#include <atomic>
#include <cmath>
#include <memory>
#include <utility>

#include "renderer/base/parallel.h"
#include "scene_io/gltf/pose/deform.h"
#include "scene_io/gltf/pose/influence.h"

namespace parian {
namespace {

constexpr double kAffineTolerance = 1e-5;

/// Node to world, of every node that no cycle keeps from its root: validate() refuses cycles later. No
/// recursion, since trees may be as deep as the file is long.
std::vector<Mat4d> find_to_world(const std::vector<Node>& nodes) {
  std::vector<int> parent(nodes.size(), kNone);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (const int child : nodes[i].children) parent[std::size_t(child)] = int(i);
  std::vector<Mat4d> to_world(nodes.size());
  std::vector<int> open;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (parent[i] == kNone) open.push_back(int(i));
  while (!open.empty()) {
    const int index = open.back();
    open.pop_back();
    const Node& node = nodes[std::size_t(index)];
    const int above = std::exchange(parent[std::size_t(index)], index);  // so that it comes once
    to_world[std::size_t(index)] = node.transform.to_matrix();
    if (above != kNone) to_world[std::size_t(index)] *= to_world[std::size_t(above)];
    for (const int child : node.children)
      if (parent[std::size_t(child)] == index) open.push_back(child);
  }
  return to_world;
}

void add(Affined& sum, const Affined& joint, double weight) {
  sum.x += joint.x * weight;
  sum.y += joint.y * weight;
  sum.z += joint.z * weight;
  sum.origin += joint.origin * weight;
}

/// The map of a vertex: the mean of its joints' by its weights, whatever these sum to. A vertex without
/// weight follows the first joint it names.
Affined blend(const std::vector<Influences>& sets, const std::vector<Affined>& joints, std::size_t vertex) {
  double total = 0;
  for (const Influences& set : sets)
    for (int c = 0; c < 4; ++c) total += set.weights[vertex][c];
  if (!(total > 0)) return joints[std::size_t(sets.front().joints[vertex].x)];
  Affined sum{Vec3d(0), Vec3d(0), Vec3d(0), Vec3d(0)};
  for (const Influences& set : sets) {
    for (int c = 0; c < 4; ++c) {
      const double weight = set.weights[vertex][c];
      if (weight > 0) add(sum, joints[std::size_t(set.joints[vertex][c])], weight / total);
    }
  }
  return sum;
}

/// Room for a vertex attribute that is written anew, if it is there.
template <class Vector>
std::shared_ptr<Vector[]> make_like(const SharedArray<Vector>& attribute, AccessorReader& accessors,
                                    const std::string& where) {
  if (attribute.empty()) return nullptr;
  accessors.claim(attribute.bytes(), where);
  return std::make_shared_for_overwrite<Vector[]>(attribute.size());
}

template <class Vector>
void replace(SharedArray<Vector>& attribute, const std::shared_ptr<Vector[]>& by) {
  if (by) attribute = SharedArray<Vector>(by, by.get(), attribute.size());
}

}  // namespace

Skins::Skins(const GltfDocument& document, AccessorReader& accessors, const std::vector<Node>& nodes)
    : document_(document), accessors_(accessors), to_world_(find_to_world(nodes)) {}

const std::vector<Affined>& Skins::joints(int skin) {
  if (const auto known = joints_.find(skin); known != joints_.end()) return known->second;
  const auto& source = document_.model.skins[std::size_t(skin)];
  const std::string where = fmt::format("/skins/{}", skin);
  const std::size_t count = source.joints.size();
  if (count == 0) document_.fail(where + "/joints", "expected at least one joint");
  accessors_.claim(count * sizeof(Affined), where);
  SharedArray<float> inverse_bind;
  const std::string place = where + "/inverseBindMatrices";
  if (source.inverseBindMatrices >= 0) {
    inverse_bind = accessors_.numbers(source.inverseBindMatrices, TINYGLTF_TYPE_MAT4, {}, place);
    if (inverse_bind.size() < 16 * count) {
      document_.fail(place, fmt::format("expected at least {} elements, the number of joints, not {}", count,
                                        inverse_bind.size() / 16));
    }
  }
  std::vector<Affined> maps(count);
  for (std::size_t j = 0; j < count; ++j) {
    Mat4d m = to_world_[std::size_t(source.joints[j])];
    if (!inverse_bind.empty()) {
      Mat4d bind;  // glTF's columns are the rows here
      for (int i = 0; i < 16; ++i) {
        bind[i / 4][i % 4] = inverse_bind[16 * j + std::size_t(i)];
        if (i % 4 == 3 && std::abs(bind[i / 4][3] - (i == 15)) > kAffineTolerance)
          document_.fail(place,
                         fmt::format("expected affine matrices; element {} has a last row that is not 0 "
                                     "0 0 1",
                                     j));
      }
      m = bind * m;
    }
    const auto row = [&](int i) { return Vec3d(m[i][0], m[i][1], m[i][2]); };
    maps[j] = {row(0), row(1), row(2), row(3)};
  }
  return joints_[skin] = std::move(maps);
}

bool Skins::apply(int skin, const tinygltf::Primitive& source, const std::string& where,
                  Primitive& primitive) {
  const std::vector<Affined>& joints = this->joints(skin);
  const std::size_t count = primitive.positions.size();
  const auto sets = read_influences(document_, accessors_, source, joints.size(), count, where);
  const auto positions = make_like(primitive.positions, accessors_, where);
  const auto normals = make_like(primitive.normals, accessors_, where);
  const auto tangents = make_like(primitive.tangents, accessors_, where);
  std::atomic<std::size_t> mirrored = 0;
  parallel_chunks(count, [&](std::size_t begin, std::size_t end) {
    std::size_t mirrored_here = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Affined map = blend(sets, joints, i);
      const bool is_mirrored = map.determinant() < 0;
      mirrored_here += is_mirrored;
      positions[i] = Vec3f(map.point(Vec3d(primitive.positions[i])));
      if (!is_finite(positions[i]))
        document_.fail(where, fmt::format("expected a finite position of vertex {} in skin {}", i, skin));
      if (normals) normals[i] = unit_or_zero(map.normal(Vec3d(primitive.normals[i])));
      if (!tangents) continue;
      const Vec4f& t = primitive.tangents[i];
      const Vec3f direction = unit_or_zero(map.vector(Vec3d(t.x, t.y, t.z)));
      // The bitangent of a mirrored frame is on the other side of n x t.
      tangents[i] = Vec4f(direction.x, direction.y, direction.z, is_mirrored ? -t.w : t.w);
    }
    mirrored += mirrored_here;
  });
  replace(primitive.positions, positions);
  replace(primitive.normals, normals);
  replace(primitive.tangents, tangents);
  return mirrored > count / 2;
}

}  // namespace parian
