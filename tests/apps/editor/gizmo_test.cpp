#include "apps/editor/gizmo.h"

#include <gtest/gtest.h>

#include "editing/add.h"
#include "editing/nodes.h"
#include "editing/tree.h"
#include "tests/apps/editor/support/viewport.h"

namespace parian::editor {
namespace {

class GizmoTest : public testing::Test {
 protected:
  GizmoTest() {
    view_.target = {0.5f, 0.2f, -0.3f};
    view_.distance = 6;
    view_.yaw = 0.6f;
    view_.pitch = -0.5f;
  }
  Projector projector() const { return {view_, 640, 360}; }
  Vec2f at(const Vec3f& p) const { return *projector().project(p); }
  /// The point that `p` is taken to.
  static Vec3f moved(const Mat4d& by, const Vec3f& p) {
    Vec3d result;
    by.multVecMatrix(Vec3d(p), result);
    return Vec3f(result);
  }

  ViewCamera view_;
  Gizmo gizmo_{GizmoMode::translate, {0.4f, 0.1f, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
};

constexpr std::array kAxes{Handle::x, Handle::y, Handle::z};

// Dragging from the picture of a point of the axis to that of another moves by their distance, along the
// axis.
TEST_F(GizmoTest, MovesAlongAnAxis) {
  for (const Handle h : kAxes) {
    const Vec3f& axis = gizmo_.axis(h);
    const Mat4d by = drag_matrix(gizmo_, h, projector(), at(gizmo_.origin + axis * 0.2f),
                                 at(gizmo_.origin + axis * 0.9f), {});
    EXPECT_NEAR((moved(by, {1, 2, 3}) - Vec3f(1, 2, 3) - axis * 0.7f).length(), 0, 1e-4f) << int(h);
  }
}

TEST_F(GizmoTest, MovesInThePlaneOfTheView) {
  const Vec2f from = at(gizmo_.origin), to = from + Vec2f(40, -25);
  const Mat4d by = drag_matrix(gizmo_, Handle::all, projector(), from, to, {});
  const Vec3f p = moved(by, gizmo_.origin);
  EXPECT_NEAR((at(p) - to).length(), 0, 0.05f) << "it goes where the pointer goes";
  EXPECT_NEAR((p - gizmo_.origin).dot(projector().to_eye(gizmo_.origin)), 0, 1e-4f);
}

TEST_F(GizmoTest, TurnsAsThePointerDoes) {
  gizmo_.mode = GizmoMode::rotate;
  for (const Handle h : {Handle::x, Handle::y, Handle::z, Handle::all}) {
    const Vec2f centre = at(gizmo_.origin);
    // A quarter of a turn, as it is seen.
    const Mat4d by = drag_matrix(gizmo_, h, projector(), centre + Vec2f(50, 0), centre + Vec2f(0, 50), {});
    const Vec3f axis = h == Handle::all ? projector().to_eye(gizmo_.origin) : gizmo_.axis(h);
    const Vec3f across = make_frame(normalize(axis)).x,
                turned = moved(by, gizmo_.origin + across) - gizmo_.origin;
    EXPECT_NEAR(turned.dot(across), 0, 1e-4f) << int(h);
    EXPECT_NEAR(turned.dot(axis), 0, 1e-4f) << int(h);
    EXPECT_NEAR((moved(by, gizmo_.origin) - gizmo_.origin).length(), 0, 1e-5f);
    // To the right, then down: clockwise.
    const Vec3f right = view_.right() - axis * view_.right().dot(axis);
    const Vec3f after = moved(by, gizmo_.origin + right) - gizmo_.origin;
    if (h == Handle::all) {
      EXPECT_LT(after.dot(view_.up()), 0) << "clockwise";
    }
  }
}

TEST_F(GizmoTest, ScalesAlongAnAxisAndByOneFactor) {
  gizmo_.mode = GizmoMode::scale;
  for (const Handle h : kAxes) {
    const Vec3f& axis = gizmo_.axis(h);
    const Mat4d by = drag_matrix(gizmo_, h, projector(), at(gizmo_.origin + axis * 0.5f),
                                 at(gizmo_.origin + axis * 1.25f), {});
    for (const Handle other : kAxes) {
      const Vec3f p = gizmo_.axis(other);
      EXPECT_NEAR((moved(by, gizmo_.origin + p) - gizmo_.origin - p * (other == h ? 2.5f : 1)).length(), 0,
                  1e-3f);
    }
  }
  const Vec2f from = at(gizmo_.origin);
  const Mat4d by = drag_matrix(gizmo_, Handle::all, projector(), from, from + Vec2f(60, 0), {});
  const Vec3f p(0.3f, -0.2f, 0.9f), after = moved(by, gizmo_.origin + p) - gizmo_.origin;
  EXPECT_GT(after.length() / p.length(), 1.2f);
  EXPECT_NEAR(normalize(after).dot(normalize(p)), 1, 1e-5f);
}

TEST_F(GizmoTest, Snaps) {
  const Vec3f& axis = gizmo_.axes.x;
  const Mat4d by =
      drag_matrix(gizmo_, Handle::x, projector(), at(gizmo_.origin), at(gizmo_.origin + axis * 0.57f),
                  {.translation = 0.25f, .rotation = 0, .scale = 0});
  EXPECT_NEAR((moved(by, {0, 0, 0}) - axis * 0.5f).length(), 0, 1e-5f);
}

TEST_F(GizmoTest, SaysNothingAlongTheLineOfSight) {
  view_.yaw = view_.pitch = 0;
  view_.target = gizmo_.origin;
  EXPECT_EQ(drag_matrix(gizmo_, Handle::z, projector(), {320, 180}, {350, 200}, {}), Mat4d());
  EXPECT_EQ(drag_matrix(gizmo_, Handle::none, projector(), {320, 180}, {350, 200}, {}), Mat4d());
}

TEST_F(GizmoTest, FindsTheHandleBelowThePointer) {
  for (const GizmoMode mode : {GizmoMode::translate, GizmoMode::rotate, GizmoMode::scale}) {
    gizmo_.mode = mode;
    for (const GizmoLine& line : gizmo_lines(gizmo_, projector())) {
      if (line.handle == Handle::all) continue;
      // The end of an axis, or a point of a circle that no other passes.
      EXPECT_EQ(find_handle(gizmo_, projector(), line.points[mode == GizmoMode::rotate ? 5 : 1]),
                line.handle);
    }
    EXPECT_EQ(find_handle(gizmo_, projector(), {5, 5}), Handle::none);
  }
  gizmo_.mode = GizmoMode::translate;
  EXPECT_EQ(find_handle(gizmo_, projector(), at(gizmo_.origin)), Handle::all);
}

// Along the axes of the world, whatever the parent does. Caught: a drag that takes the parent's space for it.
TEST_F(ViewportTest, TheGizmoMovesAChildAsItIsSeen) {
  Transform turned;
  turned.translation = {0.1f, 0, -0.2f};
  turned.rotation = Quatf().setAxisAngle({0, 1, 0}, 0.9f);
  turned.scale = Vec3f(0.5f);
  document_.edit("Put below", [&](Scene& s) {
    edit::reparent(s, kTall, edit::add_group(s, "parent", {kNone, turned}));
  });
  document_.select_node(kTall);
  const auto place = [&] {
    const Scene& s = document_.scene();
    return to_affine(edit::find_to_world(s, kTall, edit::find_parents(s))).origin;
  };
  const Vec3f before = place(), origin = viewport_.gizmo()->origin;
  const float along = Gizmo::kLength * viewport_.projector().metres_per_pixel(origin);
  const QPoint handle = to_pixel(origin + Vec3f(0.7f * along, 0, 0));
  drag(Qt::LeftButton, handle, to_pixel(origin + Vec3f(1.2f * along, 0, 0)) - handle);
  EXPECT_EQ(document_.history().undoText(), "Move");
  const Vec3f moved = place() - before;
  EXPECT_NEAR(moved.x, 0.5f * along, 0.05f * along);
  EXPECT_NEAR(moved.y, 0, 1e-5f);
  EXPECT_NEAR(moved.z, 0, 1e-5f);
  EXPECT_FALSE(tall().transform.matrix) << "a turned parent of one scale shears nothing";
}

}  // namespace
}  // namespace parian::editor
