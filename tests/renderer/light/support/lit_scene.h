/// A scene with its table of lights.
#pragma once

#include <utility>

#include "renderer/light/light_table.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {

/// A scene with its world and table, which point into it.
struct LitScene {
  explicit LitScene(Scene s, LightChoice choice = LightChoice::tree)
      : scene(std::move(s)), world(make_world(scene)), table(scene, world, choice) {}
  LitScene(const LitScene&) = delete;
  Scene scene;
  World world;
  LightTable table;
};

/// Sample `i` of a random sequence, as seen from p.
inline std::optional<LightSample> sample(const LitScene& lit, const Vec3f& p, std::uint32_t i,
                                         std::uint32_t seed = 1) {
  Sampler sampler(SamplerKind::independent, seed, 0, 0, i);
  return lit.table.sample({p, Vec3f(0)}, sampler.next2(), sampler);
}

inline Light make_light(LightKind kind, float intensity = 1) {
  Light light;
  light.kind = kind;
  light.intensity = intensity;
  return light;
}
inline Light rectangle(float width, float height, float radiance = 1) {
  Light light = make_light(LightKind::rectangle, radiance);
  light.width = width;
  light.height = height;
  return light;
}
inline Light disk(float diameter, float radiance = 1) {
  Light light = make_light(LightKind::disk, radiance);
  light.width = diameter;
  return light;
}
/// At `height` above the origin, shining down onto it.
inline Transform above(float height) { return look_along({0, height, 0}, {0, -1, 0}); }

/// Irradiance on a surface of normal n, red channel, nothing hidden.
inline Statistics irradiance(const LightTable& table, const Receiver& to, const Vec3f& n, int samples) {
  Statistics s;
  for (int i = 0; i < samples; ++i) {
    Sampler sampler(SamplerKind::independent, 3, 0, 0, std::uint32_t(i));
    const Vec2f u = sampler.next2();
    const auto light = table.sample(to, u, sampler);
    s.add(light ? light->radiance.x * std::max(0.0f, light->wi.dot(n)) / light->pdf : 0);
  }
  return s;
}
/// At p, for a receiver of both sides.
inline Statistics irradiance(const LitScene& lit, const Vec3f& p, const Vec3f& n, int samples) {
  return irradiance(lit.table, {p, Vec3f(0)}, n, samples);
}
/// At the origin.
inline void expect_irradiance(const Scene& scene, const Vec3f& n, double truth, double tolerance = 0.01) {
  EXPECT_TRUE(mean_is(irradiance(LitScene(scene), {0, 0, 0}, n, 200000), truth, tolerance));
}

}  // namespace parian
