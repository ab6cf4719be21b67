/// The environment as a light: radiance by direction, importance sampling, density.
#pragma once

#include "renderer/base/distribution.h"
#include "renderer/scene/scene.h"

namespace parian {

class EnvironmentLight {
 public:
  EnvironmentLight() = default;  // black
  explicit EnvironmentLight(const Scene& scene);

  bool black() const { return !scene_; }
  /// Radiance arriving from unit direction d, world space.
  Rgb eval(const Vec3f& d) const;
  /// Unit direction with the density that pdf() gives.
  Vec3f sample(const Vec2f& u, float& pdf) const;
  /// Density of sample() per solid angle at unit direction d.
  float pdf(const Vec3f& d) const;
  /// Luminance averaged over the sphere.
  float mean_luminance() const { return mean_luminance_; }

 private:
  Vec2f to_uv(const Vec3f& d) const;  // image coordinates of a world direction

  const Scene* scene_ = nullptr;
  Rgb radiance_{0, 0, 0};
  Texture texture_;  // image kNone: constant
  Affine rotation_;  // environment to world
  Distribution2D distribution_;
  float mean_luminance_ = 0;
};

}  // namespace parian
