/// What the code that Embree calls back needs of the rays that it traces; Embree passes the context on.
#pragma once

#include <span>

#include "renderer/accel/accel.h"
#include "renderer/accel/embree.h"
#include "renderer/base/random.h"
#include "renderer/scene/surface.h"

namespace parian {

/// Where a query that wants all crossings of its ray puts them.
struct Crossings {
  std::span<Hit> hits;
  const World* world;
  const Body* body;  // null: with anything
  std::uint32_t random;
  std::size_t count = 0;

  /// Where there is no more room each of those met has the same chance to be kept (Vitter 1985, Random
  /// Sampling with a Reservoir, algorithm R).
  void add(const Hit& hit) {
    if (body && !(hit.placement == body->placement && hit_part(*world, hit).medium == body->medium)) return;
    if (count < hits.size()) [[likely]] {
      hits[count++] = hit;
      return;
    }
    ++count;
    const std::size_t place = hash32(random, std::uint32_t(count)) % count;
    if (place < hits.size()) hits[place] = hit;
  }
};

struct Query : EmbreeContext {
  const void* accel;  // Accel::Impl, which knows what an Embree hit is
  const Scene* scene;
  const World* world;
  const std::uint32_t* random;     // of each ray, by its id
  Crossings* crossings = nullptr;  // where all crossings are wanted

  Query(const void* a, const Scene* s, const World* w, const std::uint32_t* r, bool coherent)
      : accel(a), scene(s), world(w), random(r) {
    init_context(*this, coherent);
  }

  /// Whether a surface of that coverage stops a ray. A hash of the ray and of `where` decides, so that a
  /// surface met twice in one place by one ray decides alike.
  bool meets(unsigned ray_id, std::uint32_t where, float coverage) const {
    return coverage >= 1 || to_unit_float(hash32(random[ray_id], where)) < coverage;
  }
};

}  // namespace parian
