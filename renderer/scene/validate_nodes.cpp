#include <algorithm>

#include "renderer/base/parallel.h"
#include "renderer/scene/check.h"

namespace parian {
namespace {

bool all_finite(const Imath::M44f& m) {
  return std::all_of(&m[0][0], &m[0][0] + 16, [](float x) { return std::isfinite(x); });
}

void check_transform(const InstanceTransform& t, const std::string& where, const Check& check) {
  if (!is_finite(t.translation)) check.fail(where + "/translation", "expected finite numbers");
  check.rotation(t.rotation, where + "/rotation");
  if (!is_finite(t.scale)) check.fail(where + "/scale", "expected finite numbers");
}

void check_matrix(const Imath::M44f& m, const std::string& where, const Check& check) {
  if (!all_finite(m)) check.fail(where, "expected finite numbers");
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
    check.fail(where, "expected an affine matrix");
}

// Millions, whose places are not written out for nothing.
void check_instances(const SharedArray<InstanceTransform>& instances, const std::string& where,
                     const Check& check) {
  parallel_chunks(instances.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const InstanceTransform& t = instances[i];
      if (!Check::is_rotation(t.rotation) || !is_finite(t.translation) || !is_finite(t.scale))
        check_transform(t, fmt::format("{}/{}", where, i), check);
    }
  });
}

void check_node(const Scene& scene, const Node& node, const std::string& where, const Check& check) {
  const Transform& t = node.transform;
  check_transform({t.translation, t.rotation, t.scale}, where + "/transform", check);
  if (t.matrix) check_matrix(*t.matrix, where + "/transform/matrix", check);
  check_instances(node.instances, where + "/instances", check);
  check.optional_index(node.mesh, scene.meshes.size(), where + "/mesh");
  check.optional_index(node.shape, scene.shapes.size(), where + "/shape");
  if (node.shape != kNone)
    check.index(node.shape_material, scene.materials.size(), where + "/shape_material");
  check.optional_index(node.camera, scene.cameras.size(), where + "/camera");
  check.optional_index(node.light, scene.lights.size(), where + "/light");
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    check.index(node.children[i], scene.nodes.size(), fmt::format("{}/children/{}", where, i));
  }
}

// One parent at most, so that a walk from the nodes without one reaches all but cycles. No recursion: a
// chain of nodes may be as deep as the file is long.
void check_forest(const Scene& scene, const Check& check) {
  std::vector<bool> taken(scene.nodes.size(), false), reached(scene.nodes.size(), false);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    for (std::size_t c = 0; c < scene.nodes[i].children.size(); ++c) {
      const auto child = std::size_t(scene.nodes[i].children[c]);
      if (taken[child])
        check.fail(fmt::format("/nodes/{}/children/{}", i, c), "expected a node without another parent");
      taken[child] = true;
    }
  }
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    if (!taken[i]) open.push_back(i);
  }
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    reached[node] = true;
    for (const int child : scene.nodes[node].children) open.push_back(std::size_t(child));
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (!reached[i]) check.fail(fmt::format("/nodes/{}/children", i), "expected no cycle");
  }
  for (std::size_t i = 0; i < scene.roots.size(); ++i) {
    const std::string where = fmt::format("/roots/{}", i);
    check.index(scene.roots[i], scene.nodes.size(), where);
    // A root counts as taken once it is listed.
    if (taken[std::size_t(scene.roots[i])])
      check.fail(where, "expected a node without a parent, listed once");
    taken[std::size_t(scene.roots[i])] = true;
  }
}

}  // namespace

void validate_nodes(const Scene& scene, const Check& check) {
  check.each("nodes", scene.nodes,
             [&](const Node& node, const std::string& where) { check_node(scene, node, where, check); });
  check_forest(scene, check);
}

}  // namespace parian
