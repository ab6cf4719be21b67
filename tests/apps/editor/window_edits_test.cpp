/// The menus that edit the scene.
#include "editing/nodes.h"
#include "editing/tree.h"
#include "tests/apps/editor/support/window.h"

namespace parian::editor {
namespace {

using Kind = Selection::Kind;

class WindowEditsTest : public WindowTest {
 protected:
  WindowEditsTest() { window_.viewport().render().set_paused(true); }  // nothing here looks at the picture
  const Node& active() { return scene().nodes[std::size_t(document().selection().active())]; }
  void select(std::vector<int> nodes) { document().select({Kind::nodes, std::move(nodes)}); }
  QStringList names() {
    QStringList all;
    for (const Node& node : scene().nodes) all << QString::fromStdString(node.name);
    return all;
  }
};

TEST_F(WindowEditsTest, AddsWhatTheMenuSays) {
  const Scene before = scene();
  const Vec3f target = window_.viewport().view().target;
  const auto shape = [this](ShapeKind kind) {
    return active().shape != kNone && scene().shapes[std::size_t(active().shape)].kind == kind;
  };
  const auto light = [this](LightKind kind) {
    return active().light != kNone && scene().lights[std::size_t(active().light)].kind == kind;
  };
  const auto is_cone = [&] {
    return shape(ShapeKind::cylinder) && scene().shapes[std::size_t(active().shape)].radius_top == 0;
  };
  const std::pair<const char*, std::function<bool()>> entries[] = {
      {"Sphere", [&] { return shape(ShapeKind::sphere); }},
      {"Cube", [&] { return shape(ShapeKind::box); }},
      {"Cone", is_cone},
      {"Cylinder", [&] { return shape(ShapeKind::cylinder) && !is_cone(); }},
      {"Plane", [&] { return shape(ShapeKind::plane); }},
      {"Point light", [&] { return light(LightKind::point); }},
      {"Spot light", [&] { return light(LightKind::spot); }},
      {"Directional light", [&] { return light(LightKind::directional); }},
      {"Rectangle light", [&] { return light(LightKind::rectangle); }},
      {"Disk light", [&] { return light(LightKind::disk); }},
      {"Camera, as the view is", [&] { return active().camera != kNone; }},
      {"Empty group", [&] { return active().name == "group" && active().children.empty(); }}};
  for (const auto& [text, is_right] : entries) {
    trigger(window_, text);
    ASSERT_EQ(scene().nodes.size(), before.nodes.size() + 1) << text;
    ASSERT_EQ(document().selection(), (Selection{Kind::nodes, {int(before.nodes.size())}})) << text;
    EXPECT_TRUE(is_right()) << text;
    const Vec3f& place = active().transform.translation;
    EXPECT_LT((place - target).length(), 1.01f * window_.viewport().view().distance) << text;
    EXPECT_EQ(steps(), 1) << text;
    trigger(window_, QString("Undo %1").arg(document().history().undoText()));
    EXPECT_EQ(scene(), before) << text;
    EXPECT_EQ(document().selection(), Selection()) << text;
  }
}

TEST_F(WindowEditsTest, Deletes) {
  const Scene before = scene();
  select({2, 6, 0});
  trigger(window_, "Delete");
  EXPECT_EQ(names(), QStringList({"ceiling", "right wall", "left wall", "short block", "light", "camera"}));
  EXPECT_EQ(document().selection(), Selection());
  EXPECT_EQ(steps(), 1);
  select({3});  // the short block, which has another number again soon
  document().history().undo();
  EXPECT_EQ(scene(), before);
  EXPECT_EQ(selected(), (std::vector<int>{2, 6, 0})) << "those that were selected then, and no others";
  document().history().redo();
  EXPECT_EQ(selected(), std::vector<int>{3});
  // A node together with what is below it.
  document().history().undo();
  document().edit("Move", [](Scene& s) { edit::reparent(s, 6, 5); });
  select({5, 6});
  trigger(window_, "Delete");
  EXPECT_EQ(scene().nodes.size(), before.nodes.size() - 2);
  // And all there is.
  std::vector<int> all;
  for (int i = 0; i < int(scene().nodes.size()); ++i) all.push_back(i);
  select(all);
  trigger(window_, "Delete");
  EXPECT_TRUE(scene().nodes.empty());
  trigger(window_, "Remove what nothing uses");
  EXPECT_TRUE(scene().meshes.empty());
  while (document().history().canUndo()) document().history().undo();
  EXPECT_EQ(scene(), before);
}

TEST_F(WindowEditsTest, DuplicatesGroupsAndUngroups) {
  const Scene before = scene();
  select({5, 6});
  trigger(window_, "Duplicate");
  EXPECT_EQ(selected(), (std::vector<int>{9, 10}));
  EXPECT_EQ(scene().nodes[9].mesh, scene().nodes[5].mesh);
  trigger(window_, "Group");
  ASSERT_EQ(selected(), std::vector<int>{11});
  EXPECT_EQ(active().children, (std::vector<int>{9, 10}));
  const Scene grouped = scene();
  trigger(window_, "Ungroup");
  EXPECT_EQ(scene().nodes.size(), before.nodes.size() + 2);
  EXPECT_EQ(edit::find_parents(scene())[9], kNone);
  EXPECT_EQ(steps(), 3);
  document().history().undo();
  EXPECT_EQ(scene(), grouped);
  document().history().undo();
  document().history().undo();
  EXPECT_EQ(scene(), before);
}

TEST_F(WindowEditsTest, SaysWhatItNeeds) {
  const Scene before = scene();
  for (const char* text : {"Delete", "Duplicate", "Group", "Ungroup", "Align camera to view"}) {
    window_.statusBar()->clearMessage();
    document().select({Kind::material, {0}});
    trigger(window_, text);
    EXPECT_TRUE(message().contains("expected")) << text;
  }
  for (const char* text : {"Ungroup", "Align camera to view"}) {
    window_.statusBar()->clearMessage();
    select({6});  // has a mesh, and is no camera
    trigger(window_, text);
    EXPECT_TRUE(message().contains("expected")) << text << message().toStdString();
  }
  EXPECT_EQ(scene(), before);
  EXPECT_EQ(steps(), 0);
}

TEST_F(WindowEditsTest, AlignsTheCameraToTheView) {
  ViewCamera view = window_.viewport().view();
  view.orbit(60, -20);
  window_.viewport().set_view(view);
  select({8});
  trigger(window_, "Align camera to view");
  EXPECT_EQ(steps(), 1);
  view.orbit(-100, 30);
  window_.viewport().set_view(view);
  trigger(window_, "Look through selected camera");
  view.orbit(100, -30);
  EXPECT_NEAR((window_.viewport().view().eye() - view.eye()).length(), 0, 1e-4f);
  EXPECT_NEAR((window_.viewport().view().forward() - view.forward()).length(), 0, 1e-4f);
}

// What is typed into a field is no shortcut; elsewhere it is.
TEST_F(WindowEditsTest, Shortcuts) {
  select({6});
  window_.viewport().setFocus();
  QTest::keyClick(&window_.viewport(), Qt::Key_E);
  EXPECT_EQ(window_.viewport().gizmo_mode(), GizmoMode::rotate);
  auto* search = window_.findChild<QLineEdit*>("search");
  search->setFocus();
  QTest::keyClicks(search, "wrf");
  QTest::keyClick(search, Qt::Key_Delete);
  EXPECT_EQ(search->text(), "wrf");
  EXPECT_EQ(window_.viewport().gizmo_mode(), GizmoMode::rotate);
  EXPECT_EQ(steps(), 0);
  window_.viewport().setFocus();
  QTest::keyClick(&window_.viewport(), Qt::Key_Delete);
  EXPECT_EQ(steps(), 1);
  QTest::keyClick(&window_.viewport(), Qt::Key_Z, Qt::ControlModifier);
  EXPECT_EQ(scene().nodes.size(), 9u);
  QTest::keyClick(&window_.viewport(), Qt::Key_Y, Qt::ControlModifier);
  EXPECT_EQ(scene().nodes.size(), 8u);
}

}  // namespace
}  // namespace parian::editor
