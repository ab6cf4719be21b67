/// What changes the view leaves the scene as it is.
#include "editing/nodes.h"
#include "editing/tree.h"
#include "tests/apps/editor/support/viewport.h"

namespace parian::editor {
namespace {

class LookTest : public ViewportTest {
 protected:
  LookTest() { viewport_.render().set_paused(true); }
  ~LookTest() override {
    EXPECT_EQ(document_.scene(), before_);
    EXPECT_EQ(steps(), 0);
    EXPECT_EQ(document_.selection(), selected_);
  }
  const ViewCamera& view() const { return viewport_.view(); }
  /// What is seen in the middle.
  Vec3f middle() { return viewport_.render().pick({160, 80})->position; }
  static double distance(const Vec3f& a, const Vec3f& b) { return double((a - b).length()); }

  Scene before_ = document_.scene();
  Selection selected_;
  ViewCamera start_ = viewport_.view();
};

TEST_F(LookTest, LooksThroughACamera) {
  EXPECT_NEAR(distance(view().eye(), {0, 0.273f, 0.8f}), 0, 1e-5);
  EXPECT_NEAR(distance(view().forward(), {0, 0, -1}), 0, 1e-5);
  EXPECT_EQ(view().camera.yfov, before_.cameras[0].yfov);
  viewport_.look_through(kTall);
  viewport_.look_through(1000);
  EXPECT_EQ(view().eye(), start_.eye()) << "no cameras";
}

// About what is seen in the middle, which the camera does not say the distance of.
TEST_F(LookTest, Orbits) {
  const Vec3f turned_about = middle();
  EXPECT_GT(distance(start_.target, turned_about), 0.5);
  for (const bool alt : {false, true}) {
    drag(alt ? Qt::LeftButton : Qt::MiddleButton, {100, 80}, {30, -10},
         alt ? Qt::AltModifier : Qt::NoModifier);
    EXPECT_NEAR(distance(view().target, turned_about), 0, 1e-3);
    EXPECT_NEAR(distance(view().eye(), turned_about), distance(start_.eye(), turned_about), 1e-3);
    EXPECT_GT(distance(view().eye(), start_.eye()), 0.05);
  }
}

TEST_F(LookTest, AimsAsSoonAsThereIsSomething) {
  const auto is_seen = [this] { return viewport_.render().pick({160, 80}).has_value(); };
  viewport_.render().set_paused(false);
  drag(Qt::RightButton, {0, 80}, {523, 0});  // it looks behind itself
  ASSERT_TRUE(wait_for([&] { return !is_seen(); }));
  const float far = view().distance;
  drag(Qt::MiddleButton, {100, 80}, {2, 0});
  EXPECT_EQ(view().distance, far);
  viewport_.set_view(start_);
  ASSERT_TRUE(wait_for(is_seen));
  const Vec3f turned_about = middle();
  drag(Qt::MiddleButton, {100, 80}, {20, 0});
  EXPECT_NEAR(distance(view().target, turned_about), 0, 1e-3);
}

TEST_F(LookTest, Pans) {
  const Vec3f point = middle();
  const QPoint at = to_pixel(point);
  drag(Qt::MiddleButton, at, {30, 20}, Qt::ShiftModifier);
  EXPECT_NEAR(distance(view().forward(), start_.forward()), 0, 1e-6);
  EXPECT_LE((to_pixel(point) - at - QPoint(30, 20)).manhattanLength(), 2) << "it goes with the pointer";
}

TEST_F(LookTest, Dollies) {
  const Vec3f goal = middle();
  const float far = float(distance(goal, start_.eye()));
  turn_wheel(2);
  EXPECT_NEAR(view().distance, 0.81f * far, 1e-3f);
  EXPECT_NEAR(distance(view().target, goal), 0, 1e-3);
  turn_wheel(-2);
  EXPECT_NEAR(view().distance, far, 1e-3f);
  EXPECT_NEAR(distance(view().eye(), start_.eye()), 0, 1e-3);
  drag(Qt::RightButton, {100, 80}, {40, 0}, Qt::AltModifier);
  EXPECT_LT(view().distance, 0.9f * far);
}

TEST_F(LookTest, TurnsTheHeadAndFlies) {
  drag(Qt::RightButton, {100, 80}, {30, 0});
  EXPECT_NEAR(distance(view().eye(), start_.eye()), 0, 1e-5);
  EXPECT_GT(distance(view().forward(), start_.forward()), 0.05);
  const Vec3f eye = view().eye();
  QTest::keyClick(&viewport_, Qt::Key_W);
  QTest::mousePress(&viewport_, Qt::RightButton, {}, {100, 80});
  QTest::keyPress(&viewport_, Qt::Key_W);
  EXPECT_TRUE(wait_for([&] { return distance(view().eye(), eye) > 0.05; }));
  QTest::keyRelease(&viewport_, Qt::Key_W);
  QTest::mouseRelease(&viewport_, Qt::RightButton, {}, {100, 80});
  EXPECT_GT(normalize(view().eye() - eye).dot(view().forward()), 0.999f) << "ahead";
  QTest::qWait(50);  // the timer that moved it ends
  const Vec3f there = view().eye();
  QTest::qWait(50);
  EXPECT_EQ(view().eye(), there);
}

TEST_F(LookTest, FramesTheSelection) {
  const auto all_inside = [&](const Box3f& box) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3f p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                    corner & 4 ? box.max.z : box.min.z);
      if (!viewport_.rect().contains(to_pixel(p))) return false;
    }
    return true;
  };
  const Box3f box = viewport_.render().bounds(kTall);
  document_.select_node(kTall);
  viewport_.frame_selection();
  EXPECT_TRUE(all_inside(box));
  EXPECT_NEAR(distance(view().target, box.center()), 0, 1e-5);
  const float near = view().distance;
  document_.select({});
  viewport_.frame_selection();
  EXPECT_GT(view().distance, 1.5f * near) << "all";
  EXPECT_TRUE(all_inside(box));
  document_.select_node(kCamera);  // of no size
  viewport_.frame_selection();
  EXPECT_NEAR(distance(view().target, {0, 0.273f, 0.8f}), 0, 1e-5);
  selected_ = {Selection::Kind::nodes, {kCamera}};
}

}  // namespace
}  // namespace parian::editor
