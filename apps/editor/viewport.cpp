#include "apps/editor/viewport.h"

#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>

#include <algorithm>
#include <cmath>

#include "editing/nodes.h"
#include "editing/properties.h"
#include "editing/tree.h"

namespace parian::editor {
namespace {

constexpr float kClickDistance = 4;  // pixels a click may move
constexpr Snap kSnap{0.1f, kPi / 12, 0.1f};

Vec2f to_vec(const QPointF& p) { return {float(p.x()), float(p.y())}; }

bool is_fly_key(int key) {
  return key == Qt::Key_W || key == Qt::Key_A || key == Qt::Key_S || key == Qt::Key_D || key == Qt::Key_Q ||
         key == Qt::Key_E;
}

/// Those of the nodes that are below none of the others: what moves when all are moved.
std::vector<int> topmost(const Scene& scene, const std::vector<int>& nodes) {
  const std::vector<int> parents = edit::find_parents(scene);
  std::vector<int> result;
  for (const int node : nodes) {
    bool covered = false;
    for (int p = parents[std::size_t(node)]; p != kNone && !covered; p = parents[std::size_t(p)])
      covered = std::ranges::find(nodes, p) != nodes.end();
    if (!covered) result.push_back(node);
  }
  return result;
}

/// Moves nodes of `start` by a map of world space.
void move_nodes(Scene& scene, const std::vector<int>& nodes, const Mat4d& by) {
  const std::vector<int> parents = edit::find_parents(scene);
  for (const int node : nodes) {
    const Mat4d parent = edit::find_to_world(scene, parents[std::size_t(node)], parents);
    const Mat4d world = scene.nodes[std::size_t(node)].transform.to_matrix() * parent;
    edit::set_matrix(scene, node, world * by * parent.inverse());
  }
}

}  // namespace

Viewport::Viewport(Document& document, QWidget* parent) : QWidget(parent), document_(document) {
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setMinimumSize(160, 90);
  setAttribute(Qt::WA_OpaquePaintEvent);
  connect(&render_, &LiveRender::frame_ready, this, [this](const QImage& image) {
    frame_ = image;
    update();
  });
  connect(&render_, &LiveRender::failed, &document_, &Document::refused);
  connect(&document_, &Document::scene_changed, this, [this](unsigned changed) {
    if (changed) render_.update(document_.share(), changed);
    // Undone or edited otherwise meanwhile: what was taken hold of may be no more.
    if (action_ == Action::gizmo && !document_.is_dragging()) action_ = Action::none;
    update();
  });
  connect(&document_, &Document::scene_replaced, this, [this] {
    looked_through_ = kNone;
    action_ = Action::none;
    render_.replace(document_.share());
  });
  connect(&document_, &Document::selection_changed, this, qOverload<>(&QWidget::update));
  connect(&status_timer_, &QTimer::timeout, this, &Viewport::show_status);
  status_timer_.start(200);
  connect(&fly_timer_, &QTimer::timeout, this, &Viewport::fly);
  render_.look(view_);
}

void Viewport::set_view(const ViewCamera& view) {
  view_ = view;
  view_changed();
}

void Viewport::view_changed() {
  render_.look(view_);
  update();
}

void Viewport::look_through(int node) {
  const Scene& scene = document_.scene();
  if (node < 0 || std::size_t(node) >= scene.nodes.size()) return;
  const int camera = scene.nodes[std::size_t(node)].camera;
  if (camera == kNone) return;
  const Affine place = to_affine(edit::find_to_world(scene, node, edit::find_parents(scene)));
  const Camera& like = scene.cameras[std::size_t(camera)];
  view_.look_through(like, place, like.lens ? like.lens->focus_distance : view_.distance);
  looked_through_ = node;
  view_changed();
}

void Viewport::frame_selection() {
  const Scene& scene = document_.scene();
  Box3f box;
  const Selection& selection = document_.selection();
  const bool some = selection.kind == Selection::Kind::nodes;
  for (const int node : some ? selection.indices : scene.roots) {
    box.extendBy(render_.bounds(node));
    if (some && box.isEmpty()) box.extendBy(gizmo()->origin);
  }
  view_.frame(box, float(width()) / float(std::max(1, height())));
  view_changed();
}

void Viewport::set_gizmo_mode(GizmoMode mode) {
  gizmo_mode_ = mode;
  update();
}

void Viewport::set_local_axes(bool local) {
  local_axes_ = local;
  update();
}

std::optional<Gizmo> Viewport::gizmo() const {
  const Selection& selection = document_.selection();
  if (selection.kind != Selection::Kind::nodes) return std::nullopt;
  const Scene& scene = document_.scene();
  const Mat4d world = edit::find_to_world(scene, selection.active(), edit::find_parents(scene));
  const Affine place = to_affine(world);
  Gizmo result{gizmo_mode_, place.origin, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  // Many a file has all meshes in world space, and its nodes where nothing is to be seen.
  const Box3f box = render_.bounds(selection.active());
  if (!box.isEmpty() && !box.intersects(place.origin)) result.origin = box.center();
  const auto long_enough = [](const Vec3f& v) { return v.length() > 1e-12f; };
  // A scale along the axes of the world would shear what is turned.
  const bool local = local_axes_ || gizmo_mode_ == GizmoMode::scale;
  if (local && long_enough(place.x) && long_enough(place.y) && long_enough(place.z))
    result.axes = {normalize(place.x), normalize(place.y), normalize(place.z)};
  return result;
}

void Viewport::show_status() {
  const LiveStatus s = render_.status();
  emit status_changed(tr("%1 samples   noise %2   %3 s%4")
                          .arg(s.samples)
                          .arg(s.noise, 0, 'g', 2)
                          .arg(s.seconds, 0, 'f', 1)
                          .arg(s.running ? "" : tr("   at rest")));
}

void Viewport::resizeEvent(QResizeEvent*) { render_.resize(size() * devicePixelRatioF()); }

void Viewport::mousePressEvent(QMouseEvent* event) {
  pressed_ = last_ = event->position();
  const bool alt = event->modifiers() & Qt::AltModifier, shift = event->modifiers() & Qt::ShiftModifier;
  if (event->button() == Qt::MiddleButton || (event->button() == Qt::LeftButton && alt)) {
    action_ = shift ? Action::pan : Action::orbit;
  } else if (event->button() == Qt::RightButton) {
    action_ = alt ? Action::dolly : Action::look;
  } else if (event->button() == Qt::LeftButton) {
    action_ = Action::click;
    dragged_ = gizmo();
    handle_ = dragged_ && !focusing_ ? find_handle(*dragged_, projector(), to_vec(pressed_)) : Handle::none;
    if (handle_ != Handle::none) {
      action_ = Action::gizmo;
      moved_ = topmost(document_.scene(), document_.selection().indices);
    }
  }
}

void Viewport::mouseMoveEvent(QMouseEvent* event) {
  const QPointF at = event->position(), moved = at - last_;
  last_ = at;
  switch (action_) {
    case Action::none: {
      const std::optional<Gizmo> g = gizmo();
      const Handle over = g ? find_handle(*g, projector(), to_vec(at)) : Handle::none;
      if (over != hovered_) update();
      hovered_ = over;
      return;
    }
    case Action::click:
      return;
    case Action::gizmo:
      return drag_gizmo(at);
    case Action::orbit:
      view_.orbit(float(moved.x()), float(moved.y()));
      break;
    case Action::look:
      view_.turn(float(moved.x()), float(moved.y()));
      break;
    case Action::pan:
      view_.pan(float(moved.x()), float(moved.y()), height());
      break;
    case Action::dolly:
      view_.dolly(float(moved.x() - moved.y()) / 20);
      break;
  }
  looked_through_ = kNone;
  view_changed();
}

void Viewport::drag_gizmo(const QPointF& to) {
  const Mat4d by =
      drag_matrix(*dragged_, handle_, projector(), to_vec(pressed_), to_vec(to), snapping_ ? kSnap : Snap());
  const QString name = gizmo_mode_ == GizmoMode::translate ? tr("Move")
                       : gizmo_mode_ == GizmoMode::rotate  ? tr("Rotate")
                                                           : tr("Scale");
  document_.drag(name, [&](Scene& scene) { move_nodes(scene, moved_, by); });
}

void Viewport::mouseReleaseEvent(QMouseEvent* event) {
  const Action action = std::exchange(action_, Action::none);
  handle_ = Handle::none;
  if (action == Action::gizmo) document_.finish_drag();
  if (action != Action::click || (to_vec(event->position()) - to_vec(pressed_)).length() > kClickDistance)
    return;
  if (std::exchange(focusing_, false))
    set_focus(event->position());
  else
    click(event->position(), event->modifiers() & (Qt::ShiftModifier | Qt::ControlModifier));
}

void Viewport::click(const QPointF& at, bool add) {
  const std::optional<Pick> pick = render_.pick(at * devicePixelRatioF());
  const bool known = pick && std::size_t(pick->node) < document_.scene().nodes.size();
  document_.select_node(known ? pick->node : kNone, add);
}

void Viewport::set_focus(const QPointF& at) {
  emit focus_set();
  const std::optional<Pick> pick = render_.pick(at * devicePixelRatioF());
  const Scene& scene = document_.scene();
  int node = looked_through_;
  if (const int active = document_.selection().active();
      document_.selection().kind == Selection::Kind::nodes &&
      scene.nodes[std::size_t(active)].camera != kNone)
    node = active;
  if (node == kNone)
    for (std::size_t i = 0; i < scene.nodes.size() && node == kNone; ++i)
      if (scene.nodes[i].camera != kNone) node = int(i);
  if (!pick || node == kNone) {
    emit document_.refused(pick ? tr("There is no camera to focus")
                                : tr("There is nothing to focus on there"));
    return;
  }
  const Mat4d world = edit::find_to_world(scene, node, edit::find_parents(scene));
  const Affine place = to_affine(world);
  const float distance = (pick->position - place.origin).dot(-normalize(place.z));
  const int camera = scene.nodes[std::size_t(node)].camera;
  document_.edit(tr("Focus"), [&](Scene& edited) {
    Camera& lens_owner = edited.cameras[std::size_t(camera)];
    if (!lens_owner.lens) lens_owner.lens.emplace();
    const auto properties = edit::camera_properties(lens_owner);
    edit::find_property(properties, "lens.focus_distance").set(edited, camera, double(distance));
  });
  if (node == looked_through_) look_through(node);
}

void Viewport::wheelEvent(QWheelEvent* event) {
  view_.dolly(float(event->angleDelta().y()) / 120);
  looked_through_ = kNone;
  view_changed();
}

bool Viewport::event(QEvent* event) {
  // While the right button turns the head, keys walk, which the window has as shortcuts.
  if (event->type() == QEvent::ShortcutOverride && action_ == Action::look &&
      is_fly_key(static_cast<QKeyEvent*>(event)->key()))
    event->accept();
  return QWidget::event(event);
}

void Viewport::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && action_ == Action::gizmo) {
    action_ = Action::none;
    document_.drop_drag();
    return;
  }
  if (event->key() == Qt::Key_Escape && std::exchange(focusing_, false)) return emit focus_set();
  if (action_ != Action::look || !is_fly_key(event->key())) return QWidget::keyPressEvent(event);
  keys_.insert(event->key());
  if (!fly_timer_.isActive()) {
    fly_clock_.start();
    fly_timer_.start(16);
  }
}

void Viewport::keyReleaseEvent(QKeyEvent* event) {
  if (!event->isAutoRepeat()) keys_.remove(event->key());
  QWidget::keyReleaseEvent(event);
}

void Viewport::focusOutEvent(QFocusEvent* event) {
  keys_.clear();
  QWidget::focusOutEvent(event);
}

void Viewport::fly() {
  const float seconds = float(fly_clock_.restart()) / 1000;
  if (keys_.isEmpty() || action_ != Action::look) return fly_timer_.stop();
  const auto held = [&](int more, int less) {
    return float(keys_.contains(more)) - float(keys_.contains(less));
  };
  const Vec3f way(held(Qt::Key_D, Qt::Key_A), held(Qt::Key_E, Qt::Key_Q), held(Qt::Key_W, Qt::Key_S));
  view_.fly(way * (view_.distance * seconds));
  looked_through_ = kNone;
  view_changed();
}

}  // namespace parian::editor
