/// find_changed_nodes().
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "editing/changed.h"
#include "editing/identical.h"
#include "renderer/session/session.h"

namespace parian {
namespace {

bool has_geometry(const Node& node) { return node.mesh != kNone || node.shape != kNone; }

struct Carried {
  bool geometry = false, light = false, camera = false;
};

/// What hangs below the node, itself included.
Carried find_carried(const Scene& scene, int node) {
  Carried carried;
  std::vector<int> open{node};
  while (!open.empty()) {
    const Node& n = scene.nodes[std::size_t(open.back())];
    open.pop_back();
    carried.geometry |= has_geometry(n);
    carried.light |= n.light != kNone;
    carried.camera |= n.camera != kNone;
    if (carried.geometry && carried.light && carried.camera) break;
    open.insert(open.end(), n.children.begin(), n.children.end());
  }
  return carried;
}

bool draws_alike(const Node& a, const Node& b) {
  return a.mesh == b.mesh && a.shape == b.shape && shares_storage(a.instances, b.instances);
}

/// Whether a map leaves nothing that a ray could hit: the world has no placement then.
bool is_flat(const Mat4d& matrix) { return to_affine(matrix).determinant() == 0; }

/// Of a node whose children are the same.
unsigned find_changed_node(const Scene& scene, int index, const Node& a, const Node& b) {
  unsigned changed = 0;
  if (!draws_alike(a, b))
    changed |= kChangedGeometry;
  else if (a.shape_material != b.shape_material)
    changed |= kChangedMaterials;
  if (a.light != b.light) changed |= kChangedLights | kChangedTransforms;
  if (a.camera != b.camera) changed |= kChangedCamera;
  const bool moved = !(a.transform == b.transform);
  const bool shown = a.visible != b.visible ||
                     (moved && is_flat(a.transform.to_matrix()) != is_flat(b.transform.to_matrix()));
  if (!moved && !shown) return changed;
  const Carried carried = find_carried(scene, index);
  if (carried.geometry) changed |= shown ? kChangedGeometry : kChangedTransforms;
  if (carried.light) changed |= kChangedLights | kChangedTransforms;
  if (carried.camera) changed |= kChangedCamera;
  return changed;
}

/// One node as the world walks them, and where it is.
struct Placed {
  int index;
  const Node* node;
  bool visible;
  Mat4d to_world;
};

/// What is drawn, shines and sees, each in the order of the walk: that of the world's arrays.
struct Walked {
  std::vector<Placed> geometry, lights, cameras;
};

Walked walk(const Scene& scene) {
  Walked walked;
  struct Open {
    int index;
    bool visible;
    Mat4d parent;
  };
  std::vector<Open> open;
  for (auto root = scene.roots.rbegin(); root != scene.roots.rend(); ++root)
    open.push_back({*root, true, Mat4d()});
  while (!open.empty()) {
    const auto [index, shown, parent] = open.back();
    open.pop_back();
    const Node& node = scene.nodes[std::size_t(index)];
    const Placed placed{index, &node, shown && node.visible, node.transform.to_matrix() * parent};
    if (has_geometry(node)) walked.geometry.push_back(placed);
    if (node.light != kNone) walked.lights.push_back(placed);
    if (node.camera != kNone) walked.cameras.push_back(placed);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      open.push_back({*child, placed.visible, placed.to_world});
  }
  return walked;
}

unsigned find_changed_geometry(const std::vector<Placed>& before, const std::vector<Placed>& after) {
  const auto same = [](const Placed& a, const Placed& b) {
    return draws_alike(*a.node, *b.node) && a.visible == b.visible &&
           is_flat(a.to_world) == is_flat(b.to_world);
  };
  if (!std::ranges::equal(before, after, same)) return kChangedGeometry;
  unsigned changed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    // Numbers of nodes are in the world, and told of hits: the least that makes it anew.
    if (before[i].node->shape_material != after[i].node->shape_material || before[i].index != after[i].index)
      changed |= kChangedMaterials;
    if (before[i].to_world != after[i].to_world) changed |= kChangedTransforms;
  }
  return changed;
}

/// Of scenes with other trees: by what the world is made of.
unsigned find_changed_tree(const Scene& before, const Scene& after) {
  const Walked old_nodes = walk(before), new_nodes = walk(after);
  unsigned changed = find_changed_geometry(old_nodes.geometry, new_nodes.geometry);
  const auto same_light = [](const Placed& a, const Placed& b) {
    return a.node->light == b.node->light && a.visible == b.visible && a.to_world == b.to_world &&
           a.index == b.index;
  };
  if (!std::ranges::equal(old_nodes.lights, new_nodes.lights, same_light))
    changed |= kChangedLights | kChangedTransforms;
  const auto same_camera = [](const Placed& a, const Placed& b) {
    return a.node->camera == b.node->camera && a.visible == b.visible && a.to_world == b.to_world;
  };
  if (!std::ranges::equal(old_nodes.cameras, new_nodes.cameras, same_camera)) changed |= kChangedCamera;
  return changed;
}

}  // namespace

unsigned find_changed_nodes(const Scene& before, const Scene& after, const SceneDelta& delta) {
  if (delta.nodes.empty() && delta.roots.empty()) return 0;
  const auto same_children = [](const Node& a, const Node& b) { return a.children == b.children; };
  const bool same_tree = delta.roots.empty() && std::ranges::all_of(delta.nodes, [&](const Splice<Node>& s) {
                           return std::ranges::equal(s.before, s.after, same_children);
                         });
  if (!same_tree) return find_changed_tree(before, after);
  unsigned changed = 0;
  for (const Splice<Node>& s : delta.nodes)
    for (std::size_t i = 0; i < s.before.size(); ++i)
      changed |= find_changed_node(after, int(s.first + i), s.before[i], s.after[i]);
  return changed;
}

}  // namespace parian
