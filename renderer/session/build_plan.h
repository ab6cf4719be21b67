/// How a session's BVH is to be built, and whether all that a render needs fits into memory: decided before
/// anything is built.
#pragma once

#include "renderer/session/session.h"

namespace parian {

struct BuildPlan {
  AccelSettings accel;
  // Bytes beside the scene and the world.
  AccelMemory accel_memory;
  LightTableBytes lights;
  std::size_t film = 0;  // with the picture that is made of it
  std::size_t peak = 0;  // of the process, what it has now included

  /// For a person: what of the peak is what.
  std::string describe() const;
};

/// The quality asked for, or the one whose time to build is best spent in view of the rays to come. Where
/// that does not fit below memory_limit(): a cheaper one, then compact. Throws std::runtime_error with the
/// estimate where nothing fits.
BuildPlan plan_build(const Scene& scene, const World& world, const RenderSettings& settings);

}  // namespace parian
