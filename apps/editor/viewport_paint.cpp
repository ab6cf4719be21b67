/// What the viewport draws.
#include <QPainter>
#include <QPolygonF>

#include "apps/editor/viewport.h"

namespace parian::editor {
namespace {

QPointF to_point(const Vec2f& v) { return {double(v.x), double(v.y)}; }

QColor color_of(Handle handle) {
  switch (handle) {
    case Handle::x:
      return {226, 76, 75};
    case Handle::y:
      return {126, 196, 62};
    case Handle::z:
      return {64, 136, 232};
    default:
      return {230, 230, 230};
  }
}

void draw_box(QPainter& painter, const Projector& seen, const Box3f& box) {
  for (int corner = 0; corner < 8; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      Vec3f a, b;
      for (int i = 0; i < 3; ++i) a[i] = b[i] = corner >> i & 1 ? box.max[i] : box.min[i];
      b[axis] = box.max[axis];
      const auto from = seen.project(a), to = seen.project(b);
      if (from && to) painter.drawLine(to_point(*from), to_point(*to));
    }
}

}  // namespace

void Viewport::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  if (frame_.isNull())
    painter.fillRect(rect(), QColor(40, 40, 40));
  else
    painter.drawImage(rect(), frame_);
  draw_bounds(painter);
  draw_gizmo(painter);
}

void Viewport::draw_bounds(QPainter& painter) const {
  const Selection& selection = document_.selection();
  if (selection.kind != Selection::Kind::nodes) return;
  std::vector<Box3f> boxes = render_.bounds(selection.indices);  // that of the active node last
  // Of very many one around all.
  constexpr std::size_t kMost = 200;
  if (boxes.size() > kMost) {
    Box3f all;
    for (const Box3f& box : boxes) all.extendBy(box);
    boxes = {all, boxes.back()};
  }
  painter.setRenderHint(QPainter::Antialiasing);
  for (const Box3f& box : boxes) {
    if (box.isEmpty()) continue;
    painter.setPen(QPen(&box == &boxes.back() ? QColor(255, 170, 40) : QColor(200, 120, 30), 1));
    draw_box(painter, projector(), box);
  }
}

void Viewport::draw_gizmo(QPainter& painter) const {
  const std::optional<Gizmo> g = gizmo();
  if (!g) return;
  painter.setRenderHint(QPainter::Antialiasing);
  const Handle lit = handle_ != Handle::none ? handle_ : hovered_;
  for (const GizmoLine& line : gizmo_lines(*g, projector())) {
    QPolygonF polygon;
    for (const Vec2f& p : line.points) polygon << to_point(p);
    if (polygon.size() < 2) continue;
    const QColor color = line.handle == lit ? QColor(255, 230, 80) : color_of(line.handle);
    painter.setPen(QPen(color, line.handle == lit ? 3 : 2, Qt::SolidLine, Qt::RoundCap));
    painter.drawPolyline(polygon);
    if (line.handle == Handle::all || g->mode == GizmoMode::rotate) continue;
    painter.setBrush(color);
    const QPointF end = polygon.last();
    if (g->mode == GizmoMode::scale)
      painter.drawRect(QRectF(end - QPointF(4, 4), QSizeF(8, 8)));
    else
      painter.drawEllipse(end, 5, 5);
    painter.setBrush(Qt::NoBrush);
  }
}

}  // namespace parian::editor
