#include "integrators/ambient_occlusion.h"

#include "integrators/features.h"
#include "renderer/base/sampling.h"

namespace parian {

void AmbientOcclusionIntegrator::estimate(const TraceContext& context, std::span<CameraPath> paths,
                                          RayCounts& counts, bool features_wanted) const {
  for (CameraPath& path : paths)
    if (!occluded(context, path, counts, features_wanted)) path.radiance = Rgb(1, 1, 1);
}

/// Whether something blocks a direction from what the camera ray met.
bool AmbientOcclusionIntegrator::occluded(const TraceContext& context, CameraPath& path, RayCounts& counts,
                                          bool features_wanted) const {
  const Hit& hit = path.hit;
  if (hit.placement == Hit::kMiss) return false;
  if (features_wanted) path.features = hit_features(context, hit, path.ray.d);
  if (hit.placement == Hit::kAreaLightHit) return false;
  const Surface surface = make_surface(context.scene, context.world, hit, path.ray.d);
  const Vec3f w = surface.frame.to_world(sample_cosine_hemisphere(path.sampler.next2()));
  // Below the geometric surface: blocked by the surface itself.
  if ((w.dot(surface.ng) > 0) != surface.front) return true;
  const float distance = settings_.occlusion_distance > 0 ? settings_.occlusion_distance : kInfinity;
  ++counts.shadow;
  return context.accel.occluded({ray_origin(surface, w), w, distance}, path.sampler.key());
}

}  // namespace parian
