/// What the code that Embree calls back needs of the rays that it traces; Embree passes the context on.
#pragma once

#include <span>

#include "renderer/accel/embree.h"
#include "renderer/base/random.h"
#include "renderer/scene/surface.h"

namespace parian {

/// Where a query that wants all crossings of its ray puts them.
struct Crossings {
  std::span<Hit> hits;
  std::size_t count = 0;
  const void* accel = nullptr;  // Accel::Impl, which knows what an Embree hit is

  void add(const Hit& hit) {
    if (count < hits.size()) hits[count++] = hit;
  }
};

struct Query : EmbreeContext {
  const Scene* scene;
  const World* world;
  const std::uint32_t* random;     // of each ray, by its id
  Crossings* crossings = nullptr;  // where all crossings are wanted

  Query(const Scene* s, const World* w, const std::uint32_t* r, bool coherent)
      : scene(s), world(w), random(r) {
    init_context(*this, coherent);
  }

  /// Whether a surface of that coverage stops a ray. A hash of the ray and of `where` decides, so that a
  /// surface met twice in one place by one ray decides alike.
  bool meets(unsigned ray_id, std::uint32_t where, float coverage) const {
    return coverage >= 1 || to_unit_float(hash32(random[ray_id], where)) < coverage;
  }
};

}  // namespace parian
