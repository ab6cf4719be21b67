#include "renderer/scene/node_bounds.h"

#include <ranges>

namespace parian {
namespace {

struct Link {
  int node, parent;
};

/// The nodes that are among those marked, or below one, parents before children.
std::vector<Link> find_subtrees(const Scene& scene, const std::vector<bool>& marked) {
  std::vector<Link> found, open;
  for (const int root : scene.roots) open.push_back({root, kNone});
  std::vector<bool> inside = marked;
  while (!open.empty()) {
    const Link link = open.back();
    open.pop_back();
    const bool covered = link.parent != kNone && inside[std::size_t(link.parent)];
    if (covered) inside[std::size_t(link.node)] = true;
    if (inside[std::size_t(link.node)]) found.push_back({link.node, covered ? link.parent : kNone});
    for (const int child : scene.nodes[std::size_t(link.node)].children) open.push_back({child, link.node});
  }
  return found;
}

void extend(Box3f& bounds, const Box3f& box, const Affine& to_world) {
  if (box.isEmpty()) return;
  for (int corner = 0; corner < 8; ++corner)
    bounds.extendBy(to_world.point({corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                    corner & 4 ? box.max.z : box.min.z}));
}

}  // namespace

std::vector<Box3f> subtree_bounds(const Scene& scene, const World& world, std::span<const int> nodes) {
  const auto exists = [&](int node) { return node >= 0 && std::size_t(node) < scene.nodes.size(); };
  std::vector<bool> marked(scene.nodes.size(), false);
  for (const int node : nodes)
    if (exists(node)) marked[std::size_t(node)] = true;
  const std::vector<Link> subtrees = find_subtrees(scene, marked);
  for (const Link& link : subtrees) marked[std::size_t(link.node)] = true;
  // What each node draws itself, and then what those below it do.
  std::vector<Box3f> boxes(scene.nodes.size());
  for (const Placement& p : world.placements)
    if (marked[std::size_t(p.node)])
      for (const Part& part : std::span(world.parts).subspan(p.first_part, p.part_count))
        extend(boxes[std::size_t(p.node)], part.bounds, p.to_world);
  for (const PlacedSolid& solid : world.solids)
    if (marked[std::size_t(solid.node)])
      boxes[std::size_t(solid.node)].extendBy(bounds(solid.solid, solid.to_world));
  for (const AreaLight& light : world.area_lights)
    if (marked[std::size_t(light.node)])
      for (int corner = 0; corner < 4; ++corner)
        boxes[std::size_t(light.node)].extendBy(light.center + light.half_x * (corner & 1 ? 1 : -1) +
                                                light.half_y * (corner & 2 ? 1 : -1));
  for (const Link& link : subtrees | std::views::reverse)
    if (link.parent != kNone) boxes[std::size_t(link.parent)].extendBy(boxes[std::size_t(link.node)]);
  std::vector<Box3f> result;
  for (const int node : nodes) result.push_back(exists(node) ? boxes[std::size_t(node)] : Box3f());
  return result;
}

}  // namespace parian
