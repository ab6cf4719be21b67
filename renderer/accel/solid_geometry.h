/// The solids of a world as Embree user geometry: one geometry for all spheres that are round in world space,
/// as centre and radius, and one for all other solids, whose rays are taken to the solid's own space. Nothing
/// is instanced: that costs twice the memory and turns the rays in single precision (docs/measurements.md).
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/accel/embree.h"
#include "renderer/scene/surface.h"

namespace parian {

/// Which solids a geometry holds, and what Embree reads of them; at a fixed address while the geometry is.
struct SolidGeometry {
  struct Round {
    Vec3f center;
    float radius;
  };
  /// A solid that needs its map, or whose coverage is tested.
  struct Mapped {
    Affined to_object;
    Solid solid;
    std::uint32_t alpha;  // whether rays are tested
  };
  std::vector<std::uint32_t> solids;  // by primitive id: the index in World::solids
  std::vector<Round> round;           // by primitive id; one of these two is empty
  std::vector<Mapped> mapped;
  const World* world;
};

/// Sorts the solids of a world into the kinds of geometry, leaving out those that are empty.
std::vector<SolidGeometry> sort_solids(const World& world);

/// Copies from the world what Embree reads, for the solids that the geometry holds.
void fill_solids(SolidGeometry& geometry, const World& world);

/// Makes the Embree geometry, not yet committed.
RTCGeometry new_solid_geometry(RTCDevice device, SolidGeometry& geometry);

/// The hit that Embree reports for a primitive of the geometry; `g` is what it reports as the normal.
Hit to_solid_hit(const SolidGeometry& geometry, float t, unsigned primitive, float face, const Vec3f& g);

}  // namespace parian
