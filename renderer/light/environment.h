/// The environment as a light: radiance by direction, importance sampling, density.
#pragma once

#include "renderer/base/distribution.h"
#include "renderer/scene/scene.h"

namespace parian {

/// A direction to the environment: unit, world space; the radiance that arrives from there; the density per
/// solid angle with which EnvironmentLight::sample() finds it.
struct EnvironmentSample {
  Vec3f wi;
  Rgb radiance;
  float pdf;
};

class EnvironmentLight {
 public:
  EnvironmentLight() = default;  // black
  explicit EnvironmentLight(const Scene& scene);

  /// Takes on another scene of the same environment.
  void rebind(const Scene& scene) {
    if (scene_) scene_ = &scene;
  }

  bool black() const { return !scene_; }
  /// Radiance arriving from unit direction d, world space.
  Rgb eval(const Vec3f& d) const;
  /// The same with the density.
  EnvironmentSample look_up(const Vec3f& d) const;
  /// A direction by importance; pdf 0 where it is none (a pole).
  EnvironmentSample sample(const Vec2f& u) const;
  /// Luminance averaged over the sphere.
  float mean_luminance() const { return mean_luminance_; }

 private:
  // Image coordinates of a world direction, and the sine of its polar angle.
  Vec2f to_uv(const Vec3f& d, float& sin_theta) const;
  Rgb eval_image(const Vec2f& uv) const;

  const Scene* scene_ = nullptr;
  Rgb radiance_{0, 0, 0};
  Texture texture_;  // image kNone: constant
  Affine rotation_;  // environment to world
  Distribution2D distribution_;
  float mean_luminance_ = 0;
};

}  // namespace parian
