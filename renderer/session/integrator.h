/// What estimates the radiance along a camera ray: the one virtual interface of the renderer.
#pragma once

#include <cstdint>
#include <span>

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
  const MediumStack& camera_media;  // around the camera
};

/// Rays traced, by kind.
struct RayCounts {
  std::uint64_t camera = 0, scattered = 0, shadow = 0;
  std::uint64_t dropped = 0;  // samples that were not finite or negative, and counted as black

  std::uint64_t total() const { return camera + scattered + shadow; }
  void operator+=(const RayCounts& other) {
    camera += other.camera;
    scattered += other.scattered;
    shadow += other.shadow;
    dropped += other.dropped;
  }
};

/// One sample of one pixel: what an integrator is given, and what it makes of it.
struct CameraPath {
  // The camera ray, of unit direction, and what it meets (placement kMiss: nothing); the integrator may let
  // them follow the path.
  Ray ray;
  Hit hit;
  Sampler sampler;
  Rgb radiance;       // black to begin with
  Features features;  // of the first surface; of none, to begin with, where they are wanted
};

class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Makes what it needs to know of the world that it will be asked about from now on.
  virtual void prepare(const World&) {}

  /// Gives each path one unbiased sample of the radiance arriving along its ray, drawn from its sampler;
  /// fills in the features where they are `wanted`; counts the rays that it traces. The paths, one at least
  /// and RayPacket::kSize at most, are those of neighbouring pixels: side by side, each step of theirs costs
  /// less than one after the other. Called by many threads at once.
  virtual void estimate(const TraceContext& context, std::span<CameraPath> paths, RayCounts& counts,
                        bool features_wanted) const = 0;
};

}  // namespace parian
