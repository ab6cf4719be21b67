/// The path integrator: unidirectional path tracing with next-event estimation and multiple importance
/// sampling.
#pragma once

#include "integrators/subsurface.h"

namespace parian {

class PathIntegrator final : public Integrator {
 public:
  explicit PathIntegrator(const IntegratorSettings& settings) : settings_(settings) {}
  void prepare(const World& world) override;
  void estimate(const TraceContext& context, std::span<CameraPath> paths, RayCounts& counts,
                bool features_wanted) const override;

 private:
  IntegratorSettings settings_;
  std::vector<Medium> media_;                 // of the world that was prepared for
  std::vector<DiffuseMedium> diffuse_media_;  // by medium of the world; empty where none scatters
};

}  // namespace parian
