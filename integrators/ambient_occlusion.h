/// Ambient occlusion: the share of a cosine-weighted hemisphere over the first surface that nothing blocks.
#pragma once

#include "integrators/integrators.h"

namespace parian {

class AmbientOcclusionIntegrator final : public Integrator {
 public:
  explicit AmbientOcclusionIntegrator(const IntegratorSettings& settings) : settings_(settings) {}
  /// Grey in [0, 1]; the background is 1.
  void estimate(const TraceContext& context, std::span<CameraPath> paths, RayCounts& counts,
                bool features_wanted) const override;

 private:
  bool occluded(const TraceContext& context, CameraPath& path, RayCounts& counts, bool features_wanted) const;

  IntegratorSettings settings_;
};

}  // namespace parian
