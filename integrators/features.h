/// The layers of a first surface.
#pragma once

#include "materials/bsdf.h"
#include "renderer/session/integrator.h"

namespace parian {

inline Features surface_features(const TraceContext& context, const Surface& surface, const Hit& hit) {
  return {estimate_albedo(context.scene, surface), surface.frame.z, hit.t,
          std::uint32_t(context.world.placements[hit.placement].node) + 1};
}

inline Features area_light_features(const TraceContext& context, const Hit& hit) {
  const AreaLight& light = context.world.area_lights[hit.triangle];
  return {Rgb(0, 0, 0), light.normal, hit.t, std::uint32_t(light.node) + 1};
}

}  // namespace parian
