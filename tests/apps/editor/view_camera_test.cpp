#include "apps/editor/view_camera.h"

#include <gtest/gtest.h>

#include "apps/editor/projector.h"
#include "editing/nodes.h"
#include "renderer/scene/camera.h"
#include "tests/apps/editor/support/viewport.h"

namespace parian::editor {
namespace {

constexpr int kWidth = 640, kHeight = 360;

ViewCamera some_view() {
  ViewCamera view;
  view.target = {1, 2, -3};
  view.distance = 4;
  view.yaw = 0.7f;
  view.pitch = -0.4f;
  view.camera.yfov = 0.9f;
  return view;
}

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance, const char* what) {
  EXPECT_NEAR((a - b).length(), 0, tolerance) << what;
}

TEST(ViewCamera, LooksAtItsTarget) {
  const ViewCamera view = some_view();
  expect_near(view.eye() + view.forward() * 4, view.target, 1e-5f, "target");
  EXPECT_NEAR(view.right().y, 0, 1e-6f) << "the horizon is level";
  EXPECT_GT(view.up().y, 0);
  ViewCamera straight;
  expect_near(straight.forward(), {0, 0, -1}, 1e-6f, "at yaw and pitch 0 along -z");
  expect_near(straight.eye(), {0, 0, straight.distance}, 1e-6f, "eye");
}

TEST(ViewCamera, LooksThroughACamera) {
  const ViewCamera like = some_view();
  for (const float roll : {0.0f, 0.5f, -2.0f})
    for (const float pitch : {-0.4f, 1.2f}) {
      ViewCamera posed = like;
      posed.roll = roll;
      posed.pitch = pitch;
      const Affine place{posed.right(), posed.up(), -posed.forward(), posed.eye()};
      ViewCamera seen;
      seen.look_through(like.camera, place, 7);
      expect_near(seen.eye(), posed.eye(), 1e-4f, "eye");
      expect_near(seen.forward(), posed.forward(), 1e-5f, "forward");
      expect_near(seen.up(), posed.up(), 1e-5f, "up");
      EXPECT_EQ(seen.distance, 7);
    }
}

TEST(ViewCamera, TurnsAboutTheTargetOrTheEye) {
  ViewCamera view = some_view();
  view.orbit(120, -40);
  expect_near(view.target, some_view().target, 0, "orbit keeps the target");
  EXPECT_NEAR((view.eye() - view.target).length(), 4, 1e-5f);
  view = some_view();
  const Vec3f eye = view.eye();
  view.turn(120, -40);
  expect_near(view.eye(), eye, 1e-5f, "turning the head keeps the eye");
  view.orbit(0, 1e6f);
  EXPECT_LT(std::abs(view.pitch), 0.5f * kPi) << "stops before the pole";
  EXPECT_TRUE(is_finite(view.right()));
}

// What is below the pointer goes with it.
TEST(ViewCamera, PansByThePixel) {
  ViewCamera view = some_view();
  const Vec3f point = view.target;
  const Vec2f before = *Projector(view, kWidth, kHeight).project(point);
  view.pan(37, -12, kHeight);
  const Vec2f after = *Projector(view, kWidth, kHeight).project(point);
  EXPECT_NEAR(after.x - before.x, 37, 0.01f);
  EXPECT_NEAR(after.y - before.y, -12, 0.01f);
}

TEST(ViewCamera, FramesABox) {
  const Box3f box({-1, 0, 2}, {3, 1, 4});
  for (const Projection projection : {Projection::perspective, Projection::orthographic})
    for (const float aspect : {0.4f, 1.0f, 2.5f}) {
      ViewCamera view = some_view();
      view.camera.projection = projection;
      view.frame(box, aspect);
      const int height = 400, width = int(400 * aspect);
      const Projector projector(view, width, height);
      float most = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3f p(corner & 1 ? 3 : -1, corner & 2 ? 1 : 0, corner & 4 ? 4 : 2);
        const Vec2f at = *projector.project(p);
        most =
            std::max({most, std::abs(2 * at.x / float(width) - 1), std::abs(2 * at.y / float(height) - 1)});
      }
      EXPECT_LE(most, 1.0f) << "inside of the picture";
      EXPECT_GT(most, 0.4f) << "and not small in it";
    }
}

// The overlay lies on the picture: the projector, and the rays that are rendered.
TEST(Projector, AgreesWithTheRenderersCamera) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    ViewCamera view = some_view();
    view.camera.projection = projection;
    view.camera.ymag = 1.5f;
    Scene scene;
    const Scene shown = with_view(scene, view);
    const CameraView rendered = make_camera_view(shown, place_cameras(shown).at(0), kWidth, kHeight);
    const Projector projector(view, kWidth, kHeight);
    for (const Vec2f& film : {Vec2f(10, 20), Vec2f(320, 180), Vec2f(600.5f, 333)}) {
      const Ray ray = generate_ray(rendered, film);
      const Ray mine = projector.ray(film);
      expect_near(mine.o, ray.o, 1e-4f, "origin");
      expect_near(mine.d, ray.d, 1e-5f, "direction");
      const Vec2f back = *projector.project(ray.o + ray.d * 3);
      EXPECT_NEAR((back - film).length(), 0, 0.01f);
    }
  }
  EXPECT_FALSE(Projector(some_view(), 10, 10).project(some_view().eye() - some_view().forward())) << "behind";
}

TEST(WithView, KeepsAllIndices) {
  Scene scene;
  scene.nodes.resize(2);
  scene.nodes[0].camera = 0;
  scene.cameras.resize(1);
  scene.roots = {1, 0};
  const Scene shown = with_view(scene, some_view());
  ASSERT_EQ(shown.nodes.size(), 3u);
  EXPECT_EQ(shown.nodes[0], scene.nodes[0]);
  EXPECT_EQ(shown.nodes[2].camera, 1);
  EXPECT_EQ(place_cameras(shown).at(0).node, 2) << "the first camera of the world, whatever else there is";
  EXPECT_NO_THROW(validate(shown, "shown"));
}

// A picture that is paused stays what it is. Caught: edits followed at once; edits that are lost.
TEST_F(ViewportTest, AnEditWaitsForTheEndOfAPause) {
  LiveRender& render = viewport_.render();
  const Box3f before = render.bounds(kTall);
  ASSERT_FALSE(before.isEmpty());
  render.set_paused(true);
  ASSERT_TRUE(wait_for([&] { return !render.status().running; }));
  document_.edit("Hide", [](Scene& s) { edit::set_visible(s, kTall, false); });
  QTest::qWait(100);
  EXPECT_EQ(render.bounds(kTall), before) << "followed meanwhile";
  render.set_paused(false);
  EXPECT_TRUE(wait_for([&] { return render.bounds(kTall).isEmpty(); })) << "lost";
}

}  // namespace
}  // namespace parian::editor
