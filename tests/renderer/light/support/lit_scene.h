/// A scene with its table of lights.
#pragma once

#include <utility>

#include "renderer/light/light_table.h"
#include "tests/support/scenes.h"

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

}  // namespace parian
