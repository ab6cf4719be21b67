/// The menus of the window that edit what is selected, and add to the scene.
#include <QFileDialog>
#include <QMenuBar>

#include <algorithm>

#include "apps/editor/main_window.h"
#include "editing/add.h"
#include "editing/environment.h"
#include "editing/nodes.h"
#include "editing/tree.h"
#include "renderer/base/error.h"

namespace parian::editor {

void MainWindow::make_edit_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Edit"));
  QAction* undo = document_.history().createUndoAction(this, tr("Undo"));
  undo->setShortcut(QKeySequence::Undo);
  QAction* redo = document_.history().createRedoAction(this, tr("Redo"));
  // Some platforms have the second already; twice it would be ambiguous.
  QList<QKeySequence> keys = QKeySequence::keyBindings(QKeySequence::Redo);
  if (const QKeySequence common(Qt::CTRL | Qt::Key_Y); !keys.contains(common)) keys << common;
  redo->setShortcuts(keys);
  menu->addActions({undo, redo});
  menu->addSeparator();
  add_action(menu, tr("Duplicate"), Qt::CTRL | Qt::Key_D, [this] { duplicate_selected(); });
  add_action(menu, tr("Delete"), QKeySequence::Delete, [this] { remove_selected(); });
  add_action(menu, tr("Group"), Qt::CTRL | Qt::Key_G, [this] { group_selected(); });
  add_action(menu, tr("Ungroup"), Qt::CTRL | Qt::SHIFT | Qt::Key_G, [this] { ungroup_selected(); });
  menu->addSeparator();
  add_action(menu, tr("Remove what nothing uses"), {},
             [this] { document_.edit(tr("Remove unused"), [](Scene& s) { edit::remove_unused(s); }); });
  add_action(menu, tr("Environment"), {}, [this] { document_.select({Selection::Kind::environment, {}}); });
}

void MainWindow::with_nodes(const QString& name,
                            const std::function<void(Scene&, const std::vector<int>&)>& command) {
  const Selection& selection = document_.selection();
  if (selection.kind != Selection::Kind::nodes) return complain(tr("%1: expected selected nodes").arg(name));
  const std::vector<int> nodes = selection.indices;
  document_.edit(name, [&](Scene& scene) { command(scene, nodes); });
}

void MainWindow::remove_selected() {
  with_nodes(tr("Delete"), [](Scene& scene, const std::vector<int>& nodes) { edit::remove(scene, nodes); });
  document_.select({});
}

void MainWindow::duplicate_selected() {
  std::vector<int> copies;
  with_nodes(tr("Duplicate"),
             [&](Scene& scene, const std::vector<int>& nodes) { copies = edit::duplicate(scene, nodes); });
  if (!copies.empty()) document_.select({Selection::Kind::nodes, copies});
}

void MainWindow::group_selected() {
  int made = kNone;
  with_nodes(tr("Group"),
             [&](Scene& scene, const std::vector<int>& nodes) { made = edit::group(scene, nodes, "group"); });
  if (made != kNone) document_.select_node(made);
}

void MainWindow::ungroup_selected() {
  with_nodes(tr("Ungroup"),
             [](Scene& scene, const std::vector<int>& nodes) { edit::ungroup(scene, nodes.back()); });
  document_.select({});
}

void MainWindow::align_camera() {
  const ViewCamera& view = viewport_->view();
  with_nodes(tr("Align camera"), [&](Scene& scene, const std::vector<int>& nodes) {
    const int node = nodes.back();
    if (scene.nodes[std::size_t(node)].camera == kNone) throw UsageError("expected a selected camera");
    const std::vector<int> parents = edit::find_parents(scene);
    const Mat4d parent = edit::find_to_world(scene, parents[std::size_t(node)], parents);
    Transform place;
    place.translation = view.eye();
    place.rotation = view.rotation().normalized();
    edit::set_matrix(scene, node, place.to_matrix() * parent.inverse());
  });
}

void MainWindow::add(const QString& name, const std::function<int(Scene&)>& command) {
  int node = kNone;
  document_.edit(name, [&](Scene& scene) { node = command(scene); });
  if (node != kNone) document_.select_node(node);
}

void MainWindow::make_add_menu() {
  QMenu* menu = menuBar()->addMenu(tr("&Add"));
  // Of a size that suits the view: a fifth of the distance to what is looked at.
  const auto size = [this] { return 0.2f * viewport_->view().distance; };
  const auto place = [this] {
    edit::Place at;
    at.transform.translation = viewport_->view().target;
    return at;
  };
  const auto shape = [&](const QString& text, const std::function<Shape(float)>& make) {
    add_action(menu, text, {}, [=, this] {
      add(tr("Add %1").arg(text.toLower()),
          [&](Scene& s) { return edit::add_shape(s, make(size()), place()); });
    });
  };
  shape(tr("Sphere"), [](float s) { return edit::sphere(0.5f * s); });
  shape(tr("Cube"), [](float s) { return edit::box(Vec3f(s)); });
  shape(tr("Cone"), [](float s) { return edit::cone(0.5f * s, s); });
  shape(tr("Cylinder"), [](float s) { return edit::cylinder(0.5f * s, s); });
  shape(tr("Plane"), [](float s) { return edit::plane(4 * s, 4 * s); });
  add_action(menu, tr("Model from file ..."), Qt::CTRL | Qt::Key_I, [this] { import(); });
  menu->addSeparator();
  const auto light = [&](const QString& text, LightKind kind) {
    add_action(menu, text, {}, [=, this] {
      add(tr("Add %1").arg(text.toLower()), [&](Scene& scene) {
        Light made = edit::default_light(kind);
        const bool area = kind == LightKind::rectangle || kind == LightKind::disk;
        if (area) made.width = made.height = size();
        // A point or spot that lights what is as far away as it is itself by about 1.
        if (kind == LightKind::point || kind == LightKind::spot) made.intensity = 10 * size() * size();
        if (area) made.intensity = 10;
        edit::Place at = place();
        at.transform.translation.y += 2 * size();
        if (kind != LightKind::point)
          at.transform.rotation.setAxisAngle({1, 0, 0}, -0.5f * kPi);  // downwards
        return edit::add_light(scene, made, at);
      });
    });
  };
  light(tr("Point light"), LightKind::point);
  light(tr("Spot light"), LightKind::spot);
  light(tr("Directional light"), LightKind::directional);
  light(tr("Rectangle light"), LightKind::rectangle);
  light(tr("Disk light"), LightKind::disk);
  menu->addSeparator();
  add_action(menu, tr("Camera, as the view is"), {}, [this] { add_camera(); });
  add_action(menu, tr("Environment map ..."), {}, [this] { add_environment(); });
  add_action(menu, tr("Empty group"), {}, [=, this] {
    add(tr("Add group"), [&](Scene& s) { return edit::add_group(s, "group", place()); });
  });
}

void MainWindow::add_camera() {
  const ViewCamera& view = viewport_->view();
  add(tr("Add camera"), [&](Scene& scene) {
    Camera camera = view.camera;
    camera.name = "camera";
    edit::Place at;
    at.transform.translation = view.eye();
    at.transform.rotation = view.rotation().normalized();
    return edit::add_camera(scene, camera, at);
  });
}

void MainWindow::add_environment() {
  const QString path = QFileDialog::getOpenFileName(this, tr("Environment map"), {},
                                                    tr("Images (*.hdr *.exr *.png *.jpg *.jpeg *.webp)"));
  if (path.isEmpty()) return;
  document_.edit(tr("Environment map"),
                 [&](Scene& s) { edit::set_environment_image(s, path.toStdString()); });
  document_.select({Selection::Kind::environment, {}});
}

}  // namespace parian::editor
