#include "integrators/first_hit.h"

#include "integrators/features.h"

namespace parian {
namespace {

Rgb color_of(const Features& first, FirstHitIntegrator::Property property) {
  switch (property) {
    case FirstHitIntegrator::Property::albedo:
      return first.albedo;
    case FirstHitIntegrator::Property::normal:
      return Rgb(0.5f, 0.5f, 0.5f) + Rgb(first.normal.x, first.normal.y, first.normal.z) * 0.5f;
    case FirstHitIntegrator::Property::depth:
      return Rgb(first.depth, first.depth, first.depth);
  }
  return Rgb(0, 0, 0);
}

}  // namespace

void FirstHitIntegrator::estimate(const TraceContext& context, std::span<CameraPath> paths, RayCounts&,
                                  bool features_wanted) const {
  for (CameraPath& path : paths) {
    if (path.hit.placement == Hit::kMiss) continue;
    const Features first = hit_features(context, path.hit, path.ray.d);
    path.radiance = color_of(first, property_);
    if (features_wanted) path.features = first;
  }
}

}  // namespace parian
