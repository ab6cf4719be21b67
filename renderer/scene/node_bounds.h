/// Where the nodes of a scene are.
#pragma once

#include "renderer/scene/world.h"

namespace parian {

/// The bounds, in world space, of what a node and the nodes below it draw, area lights included; empty where
/// they draw nothing. Of a mesh that is turned those of its box, which may be larger. `world` is that of the
/// scene. Takes some milliseconds for a million placements.
Box3f subtree_bounds(const Scene& scene, const World& world, int node);

}  // namespace parian
