/// Bodies that scatter light, and what surrounds them.
#pragma once

#include "integrators/integrators.h"
#include "tests/integrators/support/shapes.h"

namespace parian {

/// A dense body below a smooth interface; per metre, by channel.
inline Material make_dense(const Rgb& absorption, const Rgb& scattering, float ior, float roughness = 0) {
  Material m;
  m.roughness = roughness;
  m.ior = ior;
  m.subsurface = SubsurfaceModel{.absorption = absorption, .reduced_scattering = scattering};
  return m;
}

/// The same grey, by its albedo, where a mean free path is one metre.
inline Material make_dense(float albedo, float ior, float roughness = 0) {
  return make_dense(Rgb(1 - albedo), Rgb(albedo), ior, roughness);
}

inline void set_white_sky(Scene& scene) { scene.environment.radiance = Rgb(1, 1, 1); }

/// A sky of 1 above the horizon and of 0 below it, or the other way round.
inline void set_half_sky(Scene& scene, bool above) {
  constexpr int kRows = 512;  // interpolated: the horizon is as sharp as they are narrow
  std::vector<float> values;
  for (int y = 0; y < kRows; ++y)
    for (int i = 0; i < 4 * 3; ++i) values.push_back((y < kRows / 2) == above ? 1.0f : 0.0f);
  scene.environment = {Rgb(1, 1, 1), int(scene.images.size()), Quatf(1, 0, 0, 0)};
  scene.images.push_back(make_image(4, kRows, 3, PixelType::f32, values));
}

/// A block whose top is the plane y = 0.
inline void add_block(Scene& scene, const Material& material, float thickness, float half = 1000) {
  add_mesh(scene, make_box({-half, -thickness, -half}, {half, 0, half}), add_material(scene, material));
}

/// A probe of a single point from straight above.
inline void add_probe_above(Scene& scene, const Vec3f& point, float half = 1e-3f) {
  add_probe(scene, point, {0, 1, 0}, 3, half);
}

inline IntegratorSettings with(Subsurface method, int max_depth = 1000) {
  IntegratorSettings s;
  s.subsurface = method;
  s.max_depth = max_depth;
  return s;
}

/// Reflectance at normal incidence.
inline double normal_reflectance(double ior) { return (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1)); }

/// What a white sky shows of a body, seen along its normal, that gives back `share` of what enters.
inline double seen(double ior, double share) {
  const double f0 = normal_reflectance(ior);
  return f0 + (1 - f0) * share;
}

}  // namespace parian
