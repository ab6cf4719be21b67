/// The commands of nodes.h that move nodes in the tree.
#include <algorithm>
#include <set>
#include <unordered_set>
#include <utility>

#include "editing/arguments.h"
#include "editing/nodes.h"
#include "editing/tree.h"

namespace parian::edit {
namespace {

bool is_within(int node, int ancestor, const std::vector<int>& parents) {
  while (node != kNone && node != ancestor) node = parents[std::size_t(node)];
  return node == ancestor;
}

void check_position(int position, std::size_t last) {
  if (position < 0 || std::size_t(position) > last)
    refuse(fmt::format("position: expected a number from 0 to {}, not {}", last, position));
}

void check_group(const Scene& scene, std::span<const int> nodes, const std::vector<int>& parents) {
  if (nodes.empty()) refuse("group: expected one node at least");
  for (const int node : nodes) check_node(scene, node);
  const std::unordered_set<int> members(nodes.begin(), nodes.end());
  if (members.size() != nodes.size()) refuse("group: expected each node once");
  for (const int node : nodes)
    for (int above = parents[std::size_t(node)]; above != kNone; above = parents[std::size_t(above)])
      if (members.contains(above))
        refuse(fmt::format("group: expected nodes apart, but {} is below {}", node, above));
}

}  // namespace

void reparent(Scene& scene, int node, int parent, std::optional<int> position, bool keep_world) {
  check_node(scene, node);
  check_parent(scene, parent);
  const std::vector<int> parents = find_parents(scene);
  if (parent != kNone && is_within(parent, node, parents))
    refuse("parent: expected a node outside the subtree that is moved");
  const std::vector<int>& siblings = children_of(std::as_const(scene), parent);
  const std::size_t count = siblings.size() - std::size_t(std::ranges::count(siblings, node));
  if (position) check_position(*position, count);
  move_node(scene, node, parent, position ? std::size_t(*position) : count, keep_world);
}

void reorder(Scene& scene, int node, int position) {
  check_node(scene, node);
  const int parent = find_parents(scene)[std::size_t(node)];
  std::vector<int>& siblings = children_of(scene, parent);
  if (std::ranges::find(siblings, node) == siblings.end()) refuse("node: expected one that the scene shows");
  check_position(position, siblings.size() - 1);
  take_out(siblings, node);
  siblings.insert(siblings.begin() + position, node);
}

int group(Scene& scene, std::span<const int> nodes, std::string name) {
  const std::vector<int> parents = find_parents(scene);
  check_group(scene, nodes, parents);
  const int first = nodes.front(), parent = parents[std::size_t(first)], made = int(scene.nodes.size());
  const Mat4d to_parent = find_to_world(scene, parent, parents);
  const bool moves = std::ranges::any_of(nodes, [&](int n) { return parents[std::size_t(n)] != parent; });
  if (moves && to_affine(to_parent).determinant() == 0)
    refuse("group: expected a parent of a scale other than 0, since nodes from elsewhere are to stay");
  // The new transforms first: one of them may be refused.
  std::vector<Transform> transforms;
  for (const int node : nodes) {
    const Transform& old = scene.nodes[std::size_t(node)].transform;
    transforms.push_back(parents[std::size_t(node)] == parent
                             ? old
                             : to_transform(find_to_world(scene, node, parents) * to_parent.inverse()));
  }
  scene.nodes.emplace_back().name = std::move(name);
  scene.nodes.back().children.assign(nodes.begin(), nodes.end());
  std::vector<bool> moved(scene.nodes.size(), false);
  std::set<int> old_parents;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    scene.nodes[std::size_t(nodes[i])].transform = transforms[i];
    if (nodes[i] != first) moved[std::size_t(nodes[i])] = true;
    old_parents.insert(parents[std::size_t(nodes[i])]);
  }
  std::ranges::replace(children_of(scene, parent), first, made);
  for (const int old : old_parents)
    std::erase_if(children_of(scene, old), [&](int node) { return moved[std::size_t(node)]; });
  return made;
}

std::vector<int> ungroup(Scene& scene, int node) {
  check_node(scene, node);
  const Node& n = scene.nodes[std::size_t(node)];
  if (n.mesh != kNone || n.shape != kNone || n.camera != kNone || n.light != kNone)
    refuse("group: expected a node without mesh, shape, camera and light");
  return remove(scene, node, Removal::node_alone);
}

std::vector<int> duplicate(Scene& scene, std::span<const int> nodes) {
  for (const int node : nodes) check_node(scene, node);
  const std::size_t before = scene.nodes.size();
  std::vector<int> made, copies(before, kNone);
  for (const int node : find_topmost(scene, nodes)) {
    const std::vector<int> originals = find_subtree(scene, node);
    made.push_back(int(scene.nodes.size()));
    for (std::size_t i = 0; i < originals.size(); ++i)
      copies[std::size_t(originals[i])] = made.back() + int(i);
    for (const int original : originals) {
      Node copy = scene.nodes[std::size_t(original)];
      for (int& child : copy.children) child = copies[std::size_t(child)];
      scene.nodes.push_back(std::move(copy));
    }
    for (std::size_t i = 1; i < originals.size(); ++i) copies[std::size_t(originals[i])] = kNone;
  }
  // Those left are of the topmost. Where several are of one parent they stand together, behind the last.
  const auto insert = [&](std::vector<int>& list) {
    std::vector<int> added;
    std::size_t end = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (const int copy = copies[std::size_t(list[i])]; copy != kNone) added.push_back(copy), end = i + 1;
    list.insert(list.begin() + std::ptrdiff_t(end), added.begin(), added.end());
  };
  insert(scene.roots);
  for (std::size_t i = 0; i < before; ++i) insert(scene.nodes[i].children);
  return made;
}

}  // namespace parian::edit
