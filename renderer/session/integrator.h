/// What estimates the radiance along a camera ray: the one virtual interface of the renderer.
#pragma once

#include <cstdint>

#include "renderer/accel/accel.h"
#include "renderer/base/random.h"
#include "renderer/film/film.h"
#include "renderer/light/light_table.h"

namespace parian {

/// All that an integrator reads; built by the session, constant while it renders.
struct TraceContext {
  const Scene& scene;
  const World& world;
  const Accel& accel;
  const LightTable& lights;
};

/// Rays traced, by kind.
struct RayCounts {
  std::uint64_t camera = 0, scattered = 0, shadow = 0;
  std::uint64_t dropped = 0;  // samples that were not finite or negative, and counted as black

  void operator+=(const RayCounts& other) {
    camera += other.camera;
    scattered += other.scattered;
    shadow += other.shadow;
    dropped += other.dropped;
  }
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// One unbiased sample of the radiance arriving along `ray` (unit direction), drawn from `sampler`. Fills
  /// `features` of the first surface where it is not null, and counts the rays it traces. Called by many
  /// threads at once.
  virtual Rgb radiance(const TraceContext& context, const Ray& ray, Sampler& sampler, RayCounts& counts,
                       Features* features) const = 0;
};

}  // namespace parian
