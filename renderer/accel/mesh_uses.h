/// How the meshes of a world go into its BVHs: decided alike for the build and for its estimate.
#pragma once

#include <span>
#include <vector>

#include "renderer/accel/accel.h"

namespace parian {

struct MeshUses {
  std::vector<bool> instanced;  // by mesh: it has a BVH of its own
  // Triangles are traced in pairs. All meshes alike: with both kinds Embree would send each ray through two
  // BVHs. Not set where the scene is to be edited: each mesh has a BVH of its own there, and an edit of one
  // must not change another, so pays_to_pair() decides for each.
  bool paired = false;
};

bool pays_to_pair(std::span<const Part> parts);

/// How well a mesh of its own BVH is built before it is refined: large ones of scenes to be edited quickly.
BuildQuality first_quality(std::span<const Part> parts, const AccelSettings& settings);

MeshUses find_mesh_uses(const Scene& scene, const World& world, const AccelSettings& settings);

/// Whether Embree gets a copy of the vertices. `to_world`: where they are to be in world space, else null.
inline bool copies_vertices(const SharedArray<Vec3f>& positions, const Affine* to_world) {
  return to_world || !positions.padded();
}

}  // namespace parian
