/// What the code that Embree calls back needs of the rays that it traces; Embree passes the context on.
#pragma once

#include "renderer/accel/embree.h"
#include "renderer/base/random.h"
#include "renderer/scene/world.h"

namespace parian {

struct Query : EmbreeContext {
  const Scene* scene;
  const World* world;
  const std::uint32_t* random;  // of each ray, by its id

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
