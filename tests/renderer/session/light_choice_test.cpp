// The choice of lights as a setting of a session: one picture, each with its own noise; edits keep it.
#include <gtest/gtest.h>

#include <array>

#include "tests/integrators/support/render.h"
#include "tests/renderer/session/support/session_scenes.h"

namespace parian {
namespace {

constexpr LightChoice kChoices[] = {LightChoice::uniform, LightChoice::power, LightChoice::tree};

/// A floor under a row of 30 small lamps, the brightest of them 290 times as bright as the darkest.
Scene row_of_lamps() {
  Scene scene;
  add_mesh(scene, make_quad({0, 0, 0}, {3, 0, 0}, {0, 0, -1}),
           add_material(scene, make_lambert({0.5f, 0.5f, 0.5f})));
  for (int i = 0; i < 30; ++i)
    add_mesh(scene, turned(make_quad({0.2f * float(i) - 2.9f, 0.5f, 0}, {0.05f, 0, 0}, {0, 0, -0.05f})),
             add_material(scene, make_emitter(Rgb(std::pow(1.5f, float(i * 7 % 15))))));
  add_eye(scene, {0, 0.25f, 3}, {0, -0.4f, 0}, 0.4f);
  return scene;
}

Picture render_row(LightChoice choice, std::uint32_t seed) {
  RenderSettings settings = independent_settings(96, 32, 256, seed);
  settings.light_choice = choice;
  return render(row_of_lamps(), settings, with(Strategy::light));
}

// 800,000 paths each, to 4.5 standard errors. Caught: a choice that does not reach the table, or another one;
// probabilities that do not belong to the choice.
TEST(Session, LightChoicesHaveOnePictureAndTheirOwnNoise) {
  std::array<Mean, 3> means;
  for (const LightChoice choice : kChoices)
    means[std::size_t(choice)] = mean_of(render_row(choice, 1 + unsigned(choice)), 0);
  const auto& [uniform, power, tree] = means;
  EXPECT_TRUE(means_agree(uniform, tree, 0.06));
  EXPECT_TRUE(means_agree(power, tree, 0.03));
  std::printf("standard errors: uniform %.2g, power %.2g, tree %.2g of %.3g\n", uniform.error, power.error,
              tree.error, tree.value);
  EXPECT_GT(uniform.error, 1.3 * power.error);
  EXPECT_GT(power.error, 1.3 * tree.error);
}

// Caught: lights that an edit builds anew by the tree.
TEST(Session, EditsKeepTheLightChoice) {
  for (const LightChoice choice : kChoices) {
    RenderSettings settings = small(2);
    settings.light_choice = choice;
    Scene edited = everything();
    edited.lights[0].intensity = 20;
    Session session = make_session(everything(), settings);
    session.update(std::make_shared<const Scene>(edited), kChangedLights);
    Session fresh = make_session(edited, settings);
    EXPECT_TRUE(same_bits(finish(session), finish(fresh))) << int(choice);
  }
}

}  // namespace
}  // namespace parian
