#include "integrators/ambient_occlusion.h"

#include "integrators/features.h"
#include "renderer/base/sampling.h"

namespace parian {

Rgb AmbientOcclusionIntegrator::radiance(const TraceContext& context, const Ray& ray, Sampler& sampler,
                                         RayCounts& counts, Features* features) const {
  Hit hit;
  if (!context.accel.intersect(ray, sampler.hash(), hit, true)) return Rgb(1, 1, 1);
  if (hit.placement == Hit::kAreaLightHit) {
    if (features) *features = area_light_features(context, hit);
    return Rgb(1, 1, 1);
  }
  const Surface surface = make_surface(context.scene, context.world, hit, ray.d);
  if (features) *features = surface_features(context, surface, hit);
  const Vec3f w = surface.frame.to_world(sample_cosine_hemisphere(sampler.next2()));
  // Below the geometric surface: blocked by the surface itself.
  if ((w.dot(surface.ng) > 0) != surface.front) return Rgb(0, 0, 0);
  const float distance = settings_.occlusion_distance > 0 ? settings_.occlusion_distance : kInfinity;
  ++counts.shadow;
  return context.accel.occluded({ray_origin(surface, w), w, distance}, sampler.hash()) ? Rgb(0, 0, 0)
                                                                                       : Rgb(1, 1, 1);
}

}  // namespace parian
