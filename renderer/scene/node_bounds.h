/// Where the nodes of a scene are.
#pragma once

#include <span>
#include <vector>

#include "renderer/scene/world.h"

namespace parian {

/// For each of the nodes the bounds, in world space, of what it and those below it draw, area lights
/// included; empty where they draw nothing, and for a number that the scene has no node of. Of a mesh that is
/// turned those of its box, which may be larger. `world` is that of the scene. Takes some milliseconds for a
/// hundred thousand nodes, however many are asked for.
std::vector<Box3f> subtree_bounds(const Scene& scene, const World& world, std::span<const int> nodes);

}  // namespace parian
