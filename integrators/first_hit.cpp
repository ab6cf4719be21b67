#include "integrators/first_hit.h"

#include "integrators/features.h"

namespace parian {

Rgb FirstHitIntegrator::radiance(const TraceContext& context, const Ray& ray, Sampler& sampler, RayCounts&,
                                 Features* features) const {
  Hit hit;
  if (!context.accel.intersect(ray, sampler.hash(), hit, true)) return Rgb(0, 0, 0);
  const Features first =
      hit.placement == Hit::kAreaLightHit
          ? area_light_features(context, hit)
          : surface_features(context, make_surface(context.scene, context.world, hit, ray.d), hit);
  if (features) *features = first;
  switch (property_) {
    case Property::albedo:
      return first.albedo;
    case Property::normal:
      return Rgb(0.5f, 0.5f, 0.5f) + Rgb(first.normal.x, first.normal.y, first.normal.z) * 0.5f;
    case Property::depth:
      return Rgb(first.depth, first.depth, first.depth);
  }
  return Rgb(0, 0, 0);
}

}  // namespace parian
