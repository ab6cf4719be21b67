// Edits that wait: several are applied as one, and one that was cancelled is not lost.
#include <gtest/gtest.h>

#include <functional>

#include "tests/renderer/session/support/gated_session.h"

namespace parian {
namespace {

RenderSettings editable() {
  RenderSettings settings = small(3);
  settings.accel.editable = true;
  return settings;
}

void update(Session& session, const Scene& scene, unsigned changed) {
  session.update(std::make_shared<const Scene>(scene), changed);
}

/// The picture of a session that never knew another scene or size.
Picture fresh_picture(const Scene& scene, int width, int height) {
  RenderSettings settings = editable();
  settings.width = width, settings.height = height;
  Session session = make_session(scene, settings);
  return finish(session);
}

/// As another mesh in the place of the same primitive, which only kChangedGeometry tells.
void reshape(Scene& scene, int rings) {
  const int material = scene.meshes[1].primitives[0].material;
  scene.meshes[1].primitives[0] = make_uv_sphere({0, 0.3f, 0}, 0.5f, rings);
  scene.meshes[1].primitives[0].material = material;
}

/// Both edits come while a pass is held.
void expect_both(const char* name, const std::function<void(Session&, Scene&)>& first,
                 const std::function<void(Session&, Scene&)>& second, int width = 53, int height = 37) {
  GatedSession held(everything(), editable());
  ASSERT_TRUE(held.start());
  Scene scene = everything();
  first(held.session, scene);
  second(held.session, scene);
  held.gate->open();
  held.session.wait();
  EXPECT_TRUE(same_bits(held.session.snapshot(), fresh_picture(scene, width, height))) << name;
}

// Caught: what changed, the scene, or the size of an earlier one overwritten by a later one.
TEST(WaitingEdits, AreAppliedAsOne) {
  const auto move = [](Session& session, Scene& scene) {
    scene.nodes[1].transform = translate({0, 0.5f, 0});
    update(session, scene, kChangedTransforms);
  };
  const auto reshape_mesh = [](Session& session, Scene& scene) {
    reshape(scene, 6);
    update(session, scene, kChangedGeometry);
  };
  const auto colour = [](Session& session, Scene& scene) {
    scene.materials[1].base_color = {0.9f, 0.1f, 0.1f};
    update(session, scene, kChangedMaterials);
  };
  const auto look = [](Session& session, Scene& scene) {
    scene.cameras[0].yfov = 0.4f;
    update(session, scene, kChangedCamera);
  };
  const auto resize = [](Session& session, Scene&) { session.resize(31, 17); };
  expect_both("moved, then a colour", move, colour);
  expect_both("reshaped, then a colour", reshape_mesh, colour);
  expect_both("moved, then the camera", move, look);
  expect_both("moved, then another size", move, resize, 31, 17);
  expect_both("another size, then the camera", resize, look, 31, 17);
}

/// What the builds of a session report to, to be held in one of them.
class HeldBuild {
 public:
  void on_progress() {
    if (!armed) return;
    reached = true;
    wait_until([&] { return bool(cancelling); });
    // Time for what comes right after `cancelling`.
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  std::atomic<bool> armed{false}, reached{false}, cancelling{false};
};

/// Cancels an edit of shape, colour and size in its build, with newer edits of place and size behind it or
/// not. False if the build ended nevertheless, before it was told.
bool cancel_in_build(bool newer) {
  HeldBuild build;
  RenderSettings settings = editable();
  settings.accel.on_progress = [&](double) { build.on_progress(); };
  GatedSession held(everything(), settings);
  Session& session = held.session;
  if (!held.start()) {
    ADD_FAILURE() << "no pass to be held in";
    return true;
  }
  const BuildCounts before = session.stats().builds;
  Scene scene = everything();
  reshape(scene, 60);
  scene.materials[1].base_color = {0.9f, 0.1f, 0.1f};
  build.armed = true;
  update(session, scene, kChangedGeometry | kChangedMaterials);
  session.resize(31, 17);
  held.gate->open();
  if (!wait_until([&] { return bool(build.reached); })) {
    ADD_FAILURE() << "the edit builds nothing";
    return true;
  }
  int width = 31, height = 17;
  if (newer) {
    scene.nodes[1].transform = translate({0, 0.5f, 0});
    update(session, scene, kChangedTransforms);
    width = 40, height = 30;
    session.resize(width, height);
  }
  build.cancelling = true;
  session.cancel();
  build.armed = false;
  if (session.stats().builds.top_level != before.top_level) return false;
  EXPECT_EQ(session.film().width(), 53);  // nothing of it is there
  EXPECT_TRUE(same_bits(finish(session), fresh_picture(scene, width, height)))
      << (newer ? "with newer ones" : "alone");
  return true;
}

// Caught: its scene, what changed, or its size not kept; nothing known to wait; newer scenes or sizes
// overwritten by it.
TEST(WaitingEdits, OneThatWasCancelledIsAppliedWhole) {
  for (const bool newer : {false, true}) {
    bool cancelled = false;
    for (int i = 0; i < 50 && !cancelled; ++i) cancelled = cancel_in_build(newer);
    EXPECT_TRUE(cancelled);
  }
}

}  // namespace
}  // namespace parian
