/// The ray queries, and the only code that knows Embree. A mesh that is drawn once goes into the top-level
/// BVH in world space; a mesh drawn more often, or every mesh where the scene is to be edited, has a BVH of
/// its own that is instanced. What a scene lacks (instances, alpha, area lights) is not in its BVH and costs
/// its rays nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "renderer/scene/surface.h"

namespace parian {

struct AccelSettings {
  bool editable = false;  // instance every mesh: moving one then rebuilds only the top level
};

/// What the builds of an Accel's life were: an edit must not cause more than it needs.
struct BuildCounts {
  int meshes = 0;     // BVHs or world-space copies of a mesh
  int top_level = 0;  // commits of the top-level scene
};

class Accel {
 public:
  /// The scene and world must outlive the Accel. Throws std::runtime_error where Embree fails (out of
  /// memory).
  Accel(const Scene& scene, const World& world, const AccelSettings& settings);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  /// Follows an edit that left meshes, materials' alpha and the number of placements and area lights as they
  /// were, and moved placements or area lights. `scene` and `world` replace those given before.
  void update_transforms(const Scene& scene, const World& world);
  /// Points to a scene and world that differ from those given before in nothing that the BVH holds.
  void rebind(const Scene& scene, const World& world);

  /// Nearest hit of the ray, if any; rays of unit direction. `random` decides stochastic alpha. `coherent`:
  /// neighbouring calls follow similar rays (camera rays).
  bool intersect(const Ray& ray, std::uint32_t random, Hit& hit, bool coherent = false) const;
  /// Whether anything lies in (0, tmax) of the ray, whose direction need not be of unit length.
  bool occluded(const Ray& ray, std::uint32_t random) const;

  std::size_t bytes() const;  // what Embree holds now
  BuildCounts builds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parian
