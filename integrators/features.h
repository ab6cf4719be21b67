/// The layers of a first surface.
#pragma once

#include "materials/bsdf.h"
#include "renderer/session/integrator.h"

namespace parian {

/// What a ray of direction d met, which is not nothing.
inline Features hit_features(const TraceContext& context, const Hit& hit, const Vec3f& d) {
  if (hit.placement == Hit::kAreaLightHit) {
    const AreaLight& light = context.world.area_lights[hit.triangle];
    return {Rgb(0, 0, 0), light.normal, hit.t, std::uint32_t(hit_node(context.world, hit)) + 1, 0, 0};
  }
  const Surface surface = make_surface(context.scene, context.world, hit, d);
  return {estimate_albedo(context.scene, surface),
          surface.frame.z,
          hit.t,
          std::uint32_t(hit_node(context.world, hit)) + 1,
          0,
          0};
}

}  // namespace parian
