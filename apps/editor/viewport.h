/// The viewport: shows the frames of a LiveRender, draws the gizmo over them, and turns what the mouse and
/// keys do into views, selections and edits of the document.
#pragma once

#include <QElapsedTimer>
#include <QImage>
#include <QSet>
#include <QTimer>
#include <QWidget>

#include "apps/editor/document.h"
#include "apps/editor/gizmo.h"
#include "apps/editor/live_render.h"

namespace parian::editor {

class Viewport : public QWidget {
  Q_OBJECT

 public:
  Viewport(Document& document, QWidget* parent = nullptr);

  const ViewCamera& view() const { return view_; }
  void set_view(const ViewCamera& view);
  /// Looks through a camera of the scene, by its node.
  void look_through(int node);
  /// All that is selected, or the whole scene where nothing is.
  void frame_selection();
  LiveRender& render() { return render_; }

  void set_gizmo_mode(GizmoMode mode);
  GizmoMode gizmo_mode() const { return gizmo_mode_; }
  void set_local_axes(bool local);
  void set_snapping(bool snapping) { snapping_ = snapping; }
  /// The next click sets the focus distance of the camera that is selected, of that which was looked through,
  /// or of the first one.
  void begin_focus() { focusing_ = true; }

  /// Where the gizmo stands, if anything is selected that can be moved.
  std::optional<Gizmo> gizmo() const;
  Projector projector() const { return {view_, width(), height()}; }

 signals:
  void status_changed(const QString& text);
  void focus_set();

 protected:
  bool event(QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void wheelEvent(QWheelEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;
  void keyReleaseEvent(QKeyEvent* event) override;
  void focusOutEvent(QFocusEvent* event) override;

 private:
  enum class Action { none, click, orbit, pan, look, dolly, gizmo };
  void show_status();
  void view_changed();
  void aim();
  void fly();
  void drag_gizmo(const QPointF& to);
  void click(const QPointF& at, bool add);
  void set_focus(const QPointF& at);
  void draw_gizmo(QPainter& painter) const;
  void draw_bounds(QPainter& painter) const;

  Document& document_;
  LiveRender render_;
  ViewCamera view_;
  int looked_through_ = kNone;  // node
  bool aimed_ = false;          // the view's target is where something is
  QImage frame_;
  GizmoMode gizmo_mode_ = GizmoMode::translate;
  bool local_axes_ = false, snapping_ = false, focusing_ = false;

  Action action_ = Action::none;
  Handle handle_ = Handle::none, hovered_ = Handle::none;
  QPointF pressed_, last_;
  std::optional<Gizmo> dragged_;  // as it stood when it was taken hold of
  std::vector<int> moved_;        // nodes, none below another of them
  QSet<int> keys_;
  QTimer status_timer_, fly_timer_;
  QElapsedTimer fly_clock_;
};

}  // namespace parian::editor
