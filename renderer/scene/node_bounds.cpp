#include "renderer/scene/node_bounds.h"

#include <span>

namespace parian {
namespace {

std::vector<bool> find_subtree(const Scene& scene, int node) {
  std::vector<bool> inside(scene.nodes.size(), false);
  std::vector<int> open{node};
  while (!open.empty()) {
    const int index = open.back();
    open.pop_back();
    inside[std::size_t(index)] = true;
    const std::vector<int>& children = scene.nodes[std::size_t(index)].children;
    open.insert(open.end(), children.begin(), children.end());
  }
  return inside;
}

void extend(Box3f& bounds, const Box3f& box, const Affine& to_world) {
  if (box.isEmpty()) return;
  for (int corner = 0; corner < 8; ++corner)
    bounds.extendBy(to_world.point({corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                                    corner & 4 ? box.max.z : box.min.z}));
}

}  // namespace

Box3f subtree_bounds(const Scene& scene, const World& world, int node) {
  const std::vector<bool> inside = find_subtree(scene, node);
  Box3f result;
  for (const Placement& p : world.placements) {
    if (!inside[std::size_t(p.node)]) continue;
    for (const Part& part : std::span(world.parts).subspan(p.first_part, p.part_count))
      extend(result, part.bounds, p.to_world);
  }
  for (const PlacedSolid& solid : world.solids)
    if (inside[std::size_t(solid.node)]) result.extendBy(bounds(solid.solid, solid.to_world));
  for (const AreaLight& light : world.area_lights)
    if (inside[std::size_t(light.node)])
      for (int corner = 0; corner < 4; ++corner)
        result.extendBy(light.center + light.half_x * (corner & 1 ? 1 : -1) +
                        light.half_y * (corner & 2 ? 1 : -1));
  return result;
}

}  // namespace parian
