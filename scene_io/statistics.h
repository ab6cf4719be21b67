/// What a scene holds.
#pragma once

#include <cstddef>
#include <string>

#include "renderer/scene/world.h"

namespace parian {

struct SceneStatistics {
  std::size_t triangles_stored = 0;  // each mesh once
  std::size_t triangles_drawn = 0;   // each mesh as often as it is placed
  std::size_t vertices = 0, placements = 0, primitives = 0;
  std::size_t emissive_triangles = 0;  // drawn
  std::size_t solids = 0, emissive_solids = 0;
  std::size_t alpha_primitives = 0;  // stored, tested in the intersection
  std::size_t geometry_bytes = 0;
  std::size_t image_bytes = 0, cached_image_bytes = 0;  // of texels in memory; behind a cache
};

SceneStatistics scene_statistics(const Scene& scene, const World& world);

/// As lines for a person.
std::string describe(const Scene& scene, const World& world);

}  // namespace parian
