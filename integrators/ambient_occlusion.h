/// Ambient occlusion: the share of a cosine-weighted hemisphere over the first surface that nothing blocks.
#pragma once

#include "integrators/integrators.h"

namespace parian {

class AmbientOcclusionIntegrator final : public Integrator {
 public:
  explicit AmbientOcclusionIntegrator(const IntegratorSettings& settings) : settings_(settings) {}
  /// Grey in [0, 1]; the background is 1.
  Rgb radiance(const TraceContext& context, const Ray& ray, Sampler& sampler, RayCounts& counts,
               Features* features) const override;

 private:
  IntegratorSettings settings_;
};

}  // namespace parian
