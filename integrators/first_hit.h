/// Shows one property of the first surface as the picture.
#pragma once

#include "integrators/integrators.h"

namespace parian {

class FirstHitIntegrator final : public Integrator {
 public:
  enum class Property : std::uint8_t { albedo, normal, depth };
  explicit FirstHitIntegrator(Property property) : property_(property) {}
  /// Albedo; the shading normal, each axis mapped from [-1, 1] to [0, 1]; or the distance in metres, grey.
  /// The background is black.
  Rgb radiance(const TraceContext& context, const Ray& ray, Sampler& sampler, RayCounts& counts,
               Features* features) const override;

 private:
  Property property_;
};

}  // namespace parian
