#include <algorithm>

#include "renderer/scene/check.h"

namespace parian {
namespace {

bool all_finite(const Imath::M44f& m) {
  return std::all_of(&m[0][0], &m[0][0] + 16, [](float x) { return std::isfinite(x); });
}

void check_transform(const Transform& t, const std::string& where, const Check& check) {
  if (!is_finite(t.translation)) check.fail(where + "/translation", "expected finite numbers");
  check.rotation(t.rotation, where + "/rotation");
  if (!is_finite(t.scale)) check.fail(where + "/scale", "expected finite numbers");
  if (!t.matrix) return;
  const Imath::M44f& m = *t.matrix;
  if (!all_finite(m)) check.fail(where + "/matrix", "expected finite numbers");
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1)
    check.fail(where + "/matrix", "expected an affine matrix");
}

void check_node(const Scene& scene, const Node& node, const std::string& where, const Check& check) {
  check_transform(node.transform, where + "/transform", check);
  for (std::size_t i = 0; i < node.instances.size(); ++i) {
    check_transform(node.instances[i], fmt::format("{}/instances/{}", where, i), check);
  }
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
