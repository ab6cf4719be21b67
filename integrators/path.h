/// The path integrator: unidirectional path tracing with next-event estimation and multiple importance
/// sampling.
#pragma once

#include "integrators/integrators.h"

namespace parian {

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const IntegratorSettings& settings) : settings_(settings) {}
  void estimate(const TraceContext& context, std::span<CameraPath> paths, RayCounts& counts,
                bool features_wanted) const override;

 private:
  IntegratorSettings settings_;
};

}  // namespace parian
