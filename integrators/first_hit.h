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
  void estimate(const TraceContext& context, std::span<CameraPath> paths, RayCounts& counts,
                bool features_wanted) const override;

 private:
  Property property_;
};

}  // namespace parian
