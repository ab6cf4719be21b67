/// What mouse and keys do in the viewport.
#include <QKeyEvent>
#include <QMouseEvent>

#include <utility>

#include "apps/editor/viewport.h"
#include "editing/nodes.h"
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
      moved_ = edit::find_topmost(document_.scene(), document_.selection().indices);
    }
  }
  if (action_ != Action::click && action_ != Action::gizmo && action_ != Action::none) aim();
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
      aimed_ = false;
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

void Viewport::wheelEvent(QWheelEvent* event) {
  aim();
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
  aimed_ = false;
  looked_through_ = kNone;
  view_changed();
}

}  // namespace parian::editor
