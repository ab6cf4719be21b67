/// The path integrator: unidirectional path tracing with next-event estimation and multiple importance
/// sampling.
#pragma once

#include "integrators/integrators.h"

namespace parian {

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const IntegratorSettings& settings) : settings_(settings) {}
  Rgb radiance(const TraceContext& context, const Ray& ray, Sampler& sampler, RayCounts& counts,
               Features* features) const override;

 private:
  IntegratorSettings settings_;
};

}  // namespace parian
