/// What the viewport does to the scene.
#include "apps/editor/viewport.h"

#include "editing/nodes.h"
#include "tests/apps/editor/support/viewport.h"

namespace parian::editor {
namespace {

using Kind = Selection::Kind;

TEST_F(ViewportTest, AClickSelects) {
  click(tall_block());
  EXPECT_EQ(document_.selection(), (Selection{Kind::nodes, {kTall}}));
  const QPoint ceiling =
      to_pixel(viewport_.render().bounds(1).center() - Vec3f(0.15f, 0, 0));  // beside the lamp
  click(ceiling, Qt::ShiftModifier);
  EXPECT_EQ(document_.selection(), (Selection{Kind::nodes, {kTall, 1}}));
  click(ceiling, Qt::ControlModifier);
  EXPECT_EQ(document_.selection(), (Selection{Kind::nodes, {kTall}}));
  click({2, 80});
  EXPECT_EQ(document_.selection(), Selection()) << "there is nothing beside the box";
  drag(Qt::LeftButton, tall_block(), {20, 0});
  EXPECT_EQ(document_.selection(), Selection()) << "a click that goes far is none";
  EXPECT_EQ(steps(), 0);
}

class GizmoDragTest : public ViewportTest {
 protected:
  GizmoDragTest() {
    document_.select_node(kTall);
    origin_ = viewport_.gizmo()->origin;
    along_ = Gizmo::kLength * viewport_.projector().metres_per_pixel(origin_);
    handle_ = to_pixel(origin_ + Vec3f(0.7f * along_, 0, 0));
  }
  Vec3f origin_;
  float along_;    // metres that an axis is long
  QPoint handle_;  // on the x axis
};

TEST_F(GizmoDragTest, MovesAlongTheAxis) {
  const Scene before = document_.scene();
  drag(Qt::LeftButton, handle_, to_pixel(origin_ + Vec3f(1.2f * along_, 0, 0)) - handle_);
  const Vec3f moved = tall().transform.translation;
  EXPECT_NEAR(moved.x, 0.5f * along_, 0.05f * along_);
  EXPECT_NEAR(moved.y, 0, 1e-5f);
  EXPECT_NEAR(moved.z, 0, 1e-5f);
  EXPECT_EQ(steps(), 1);
  EXPECT_EQ(document_.history().undoText(), "Move");
  EXPECT_EQ(document_.selection(), (Selection{Kind::nodes, {kTall}}));
  document_.history().undo();
  EXPECT_EQ(document_.scene(), before);
}

TEST_F(GizmoDragTest, TurnsAndScales) {
  viewport_.set_gizmo_mode(GizmoMode::scale);
  drag(Qt::LeftButton, handle_, {30, 0});
  EXPECT_EQ(document_.history().undoText(), "Scale");
  EXPECT_GT(tall().transform.scale.x, 1.1f);
  document_.history().undo();
  viewport_.set_gizmo_mode(GizmoMode::rotate);
  const std::optional<Gizmo> gizmo = viewport_.gizmo();
  for (const GizmoLine& line : gizmo_lines(*gizmo, viewport_.projector())) {
    if (line.handle != Handle::y) continue;
    const Vec2f& p = line.points[5];
    drag(Qt::LeftButton, {int(std::lround(p.x)), int(std::lround(p.y))}, {25, 10});
  }
  EXPECT_EQ(document_.history().undoText(), "Rotate");
  EXPECT_GT(std::abs(tall().transform.rotation.v.y), 0.01f);
}

TEST_F(GizmoDragTest, SnapsToSteps) {
  viewport_.set_snapping(true);
  drag(Qt::LeftButton, handle_, to_pixel(origin_ + Vec3f(0.7f * along_ + 0.13f, 0, 0)) - handle_);
  EXPECT_FLOAT_EQ(tall().transform.translation.x, 0.1f);
  viewport_.set_snapping(false);
  drag(Qt::LeftButton, handle_ + QPoint(10, 0), {7, 0});
  EXPECT_GT(std::abs(tall().transform.translation.x - 0.1f), 0.005f);
}

// Turned by a quarter about y, its own x axis is the world's -z.
TEST_F(GizmoDragTest, FollowsItsOwnAxes) {
  document_.edit("Turn", [](Scene& s) {
    Quatf turn;
    turn.setAxisAngle({0, 1, 0}, 0.5f * kPi);
    edit::set_transform(s, kTall, {.translation = {}, .rotation = turn, .scale = {}});
  });
  EXPECT_LT((viewport_.gizmo()->axes.x - Vec3f(1, 0, 0)).length(), 1e-5f);
  viewport_.set_local_axes(true);
  EXPECT_LT((viewport_.gizmo()->axes.x - Vec3f(0, 0, -1)).length(), 1e-5f);
  EXPECT_LT((viewport_.gizmo()->axes.z - Vec3f(1, 0, 0)).length(), 1e-5f);
}

TEST_F(GizmoDragTest, EscapeTakesItBack) {
  const Scene before = document_.scene();
  QTest::mousePress(&viewport_, Qt::LeftButton, {}, handle_);
  QTest::mouseMove(&viewport_, handle_ + QPoint(30, 0));
  EXPECT_NE(document_.scene(), before);
  EXPECT_EQ(steps(), 0) << "still in the hand";
  QTest::keyClick(&viewport_, Qt::Key_Escape);
  EXPECT_EQ(document_.scene(), before);
  QTest::mouseMove(&viewport_, handle_ + QPoint(40, 0));
  QTest::mouseRelease(&viewport_, Qt::LeftButton, {}, handle_ + QPoint(40, 0));
  EXPECT_EQ(document_.scene(), before);
  EXPECT_EQ(steps(), 0);
}

// The hand still holds what an undo takes away, and the scene of the history is right afterwards.
TEST_F(GizmoDragTest, UndoMeanwhile) {
  const Scene first = document_.scene();
  int copy = kNone;
  document_.edit("Duplicate", [&](Scene& s) { copy = edit::duplicate(s, kTall); });
  const Scene second = document_.scene();
  document_.select_node(copy);
  ASSERT_TRUE(wait_for([&] { return !viewport_.render().bounds(copy).isEmpty(); }));
  QTest::mousePress(&viewport_, Qt::LeftButton, {}, handle_);
  QTest::mouseMove(&viewport_, handle_ + QPoint(30, 0));
  EXPECT_NE(document_.scene(), second);
  document_.history().undo();
  EXPECT_EQ(document_.scene(), first);
  QTest::mouseMove(&viewport_, handle_ + QPoint(40, 0));
  QTest::mouseRelease(&viewport_, Qt::LeftButton, {}, handle_ + QPoint(40, 0));
  EXPECT_EQ(document_.scene(), first);
  document_.history().redo();
  EXPECT_EQ(document_.scene(), second);
  EXPECT_EQ(steps(), 1);
  // The same of another scene.
  ASSERT_TRUE(wait_for([&] { return !viewport_.render().bounds(copy).isEmpty(); }));
  QTest::mousePress(&viewport_, Qt::LeftButton, {}, handle_);
  QTest::mouseMove(&viewport_, handle_ + QPoint(30, 0));
  document_.clear();
  const Scene cleared = document_.scene();
  QTest::mouseMove(&viewport_, handle_ + QPoint(40, 0));
  QTest::mouseRelease(&viewport_, Qt::LeftButton, {}, handle_ + QPoint(40, 0));
  EXPECT_EQ(document_.scene(), cleared);
}

TEST_F(ViewportTest, FocusesOnWhatIsClicked) {
  const QPoint at = tall_block();
  const auto pick = viewport_.render().pick(at);
  ASSERT_TRUE(pick);
  QSignalSpy refusals(&document_, &Document::refused);
  viewport_.begin_focus();
  click(at);
  ASSERT_EQ(steps(), 1) << (refusals.isEmpty() ? "" : refusals[0][0].toString().toStdString());
  EXPECT_NEAR(document_.scene().cameras[0].lens->focus_distance, pick->depth, 0.01f);
  EXPECT_EQ(document_.selection(), Selection()) << "it selects nothing";
  click(at);
  EXPECT_EQ(steps(), 1) << "once";
  viewport_.begin_focus();
  click({2, 80});
  EXPECT_EQ(refusals.count(), 1);
  viewport_.begin_focus();
  QTest::keyClick(&viewport_, Qt::Key_Escape);
  click(at);
  EXPECT_EQ(steps(), 1);
}

TEST_F(ViewportTest, AnEditIsSeen) {
  // With few samples, or seen from elsewhere, it is darker.
  ASSERT_TRUE(wait_for(
      [&] { return viewport_.render().status().samples >= 16 && mean_of(shown(), shown().rect()) > 10; }));
  const QPoint at = tall_block();
  const QRect part(at - QPoint(3, 3), QSize(7, 7));
  const double before = mean_of(shown(), part);
  document_.edit("Paint", [](Scene& s) { s.materials[0].emission = Rgb(20); });
  EXPECT_TRUE(wait_for([&] { return mean_of(shown(), part) > before + 20; }));
  document_.history().undo();
  EXPECT_TRUE(wait_for([&] { return std::abs(mean_of(shown(), part) - before) < 20; }));
}

TEST_F(ViewportTest, PausesAndGoesOn) {
  viewport_.render().set_paused(true);
  ASSERT_TRUE(wait_for([&] { return !viewport_.render().status().running; }));
  const int frames = int(frames_.count());
  document_.edit("Hide", [](Scene& s) { edit::set_visible(s, kTall, false); });
  QTest::qWait(100);
  EXPECT_LE(frames_.count(), frames + 1) << "that of before the pause";
  viewport_.render().set_paused(false);
  EXPECT_TRUE(wait_for([&] { return viewport_.render().bounds(kTall).isEmpty(); })) << "the edit is not lost";
  EXPECT_TRUE(wait_for([&] { return frames_.count() > frames + 1; }));
}

}  // namespace
}  // namespace parian::editor
