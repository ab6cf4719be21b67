/// The handles by which a node is moved, turned and scaled in the viewport. Knows nothing of windows.
#pragma once

#include <vector>

#include "apps/editor/projector.h"

namespace parian::editor {

enum class GizmoMode : std::uint8_t { translate, rotate, scale };

/// What of a gizmo is taken hold of: an axis, or all of them (in the plane of the view, about the line of
/// sight, by one factor).
enum class Handle : std::uint8_t { none, x, y, z, all };

struct Gizmo {
  GizmoMode mode = GizmoMode::translate;
  Vec3f origin{0, 0, 0};
  Frame axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  // unit; need not be orthogonal

  static constexpr float kLength = 90;  // of an axis, pixels
  static constexpr float kReach = 8;    // how near a pointer has to be to a handle, pixels
  const Vec3f& axis(Handle h) const { return h == Handle::x ? axes.x : h == Handle::y ? axes.y : axes.z; }
};

/// A line on the screen, in pixels, that belongs to a handle.
struct GizmoLine {
  Handle handle;
  std::vector<Vec2f> points;
};

/// All that there is to draw and to take hold of.
std::vector<GizmoLine> gizmo_lines(const Gizmo& gizmo, const Projector& projector);

/// The handle nearest to the pointer, or none.
Handle find_handle(const Gizmo& gizmo, const Projector& projector, const Vec2f& pointer);

/// Steps that a drag snaps to; 0: it does not. Metres, radians, factor.
struct Snap {
  float translation = 0, rotation = 0, scale = 0;
};

/// The map of world space (row vectors) that a drag of the handle from one pixel to another stands for. The
/// identity where the drag says nothing, as along an axis that points to the eye.
Mat4d drag_matrix(const Gizmo& gizmo, Handle handle, const Projector& projector, const Vec2f& from,
                  const Vec2f& to, const Snap& snap);

}  // namespace parian::editor
