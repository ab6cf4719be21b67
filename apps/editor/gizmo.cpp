#include "apps/editor/gizmo.h"

#include <array>
#include <cmath>

namespace parian::editor {
namespace {

constexpr std::array kAxes{Handle::x, Handle::y, Handle::z};
constexpr int kCircleSteps = 64;

float distance_to_segment(const Vec2f& p, const Vec2f& a, const Vec2f& b) {
  const Vec2f d = b - a;
  const float length2 = d.dot(d);
  const float t = length2 > 0 ? std::clamp((p - a).dot(d) / length2, 0.0f, 1.0f) : 0;
  return (p - a - d * t).length();
}

float snapped(float value, float step) { return step > 0 ? std::round(value / step) * step : value; }

GizmoLine line(Handle handle, const Projector& projector, const std::vector<Vec3f>& points) {
  GizmoLine result{handle, {}};
  for (const Vec3f& p : points)
    if (const auto at = projector.project(p)) result.points.push_back(*at);
  return result;
}

std::vector<Vec3f> circle(const Vec3f& centre, const Vec3f& normal, float radius) {
  const Frame frame = make_frame(normalize(normal));
  std::vector<Vec3f> points;
  for (int i = 0; i <= kCircleSteps; ++i) {
    const float angle = 2 * kPi * float(i) / kCircleSteps;
    points.push_back(centre + (frame.x * std::cos(angle) + frame.y * std::sin(angle)) * radius);
  }
  return points;
}

/// Where on the axis, in metres from the origin, the ray passes nearest; nothing where they are parallel.
std::optional<float> along_axis(const Vec3f& origin, const Vec3f& axis, const Ray& ray) {
  const float cosine = axis.dot(ray.d), sine2 = 1 - cosine * cosine;
  if (sine2 < 1e-4f) return std::nullopt;
  const Vec3f w = ray.o - origin;
  return (w.dot(axis) - w.dot(ray.d) * cosine) / sine2;
}

std::optional<Vec3f> on_plane(const Vec3f& origin, const Vec3f& normal, const Ray& ray) {
  const float cosine = normal.dot(ray.d);
  if (std::abs(cosine) < 1e-3f) return std::nullopt;
  return ray.o + ray.d * ((origin - ray.o).dot(normal) / cosine);
}

Mat4d translation(const Vec3f& by) { return Mat4d().setTranslation(Vec3d(by)); }

Mat4d about(const Vec3f& origin, const Mat4d& map) {
  return translation(-origin) * map * translation(origin);
}

Mat4d translate(const Gizmo& g, Handle handle, const Ray& from, const Ray& to, const Vec3f& to_eye,
                float step) {
  if (handle == Handle::all) {
    const auto a = on_plane(g.origin, to_eye, from), b = on_plane(g.origin, to_eye, to);
    if (!a || !b) return {};
    const Vec3f by = *b - *a;
    return translation({snapped(by.x, step), snapped(by.y, step), snapped(by.z, step)});
  }
  const Vec3f& axis = g.axis(handle);
  const auto a = along_axis(g.origin, axis, from), b = along_axis(g.origin, axis, to);
  return a && b ? translation(axis * snapped(*b - *a, step)) : Mat4d();
}

Mat4d rotate(const Gizmo& g, Handle handle, const Projector& projector, const Vec2f& from, const Vec2f& to,
             float step) {
  const Vec3f to_eye = projector.to_eye(g.origin);
  const Vec3f axis = handle == Handle::all ? to_eye : g.axis(handle);
  const auto centre = projector.project(g.origin);
  if (!centre) return {};
  // The angle as it is seen about the origin: right for every axis, also for one across the line of sight,
  // whose circle is seen from its edge.
  const Vec2f a = from - *centre, b = to - *centre;
  if (a.length() < 1 || b.length() < 1) return {};
  const float seen = std::atan2(a.x * b.y - a.y * b.x, a.dot(b));  // clockwise, as y is down
  const float angle = snapped(axis.dot(to_eye) >= 0 ? -seen : seen, step);
  Imath::Quatd q;
  q.setAxisAngle(Vec3d(axis), double(angle));
  return about(g.origin, q.toMatrix44());
}

Mat4d scale(const Gizmo& g, Handle handle, const Projector& projector, const Vec2f& from, const Vec2f& to,
            float step) {
  const auto centre = projector.project(g.origin);
  if (!centre) return {};
  const auto factor = [&](float before, float after) {
    if (std::abs(before) < 1e-3f) return 1.0f;
    const float f = snapped(after / before, step);
    return std::abs(f) < 1e-3f ? std::copysign(1e-3f, f) : f;  // a scale of 0 cannot be undone by hand
  };
  if (handle == Handle::all) {
    const float f = factor(1, std::exp((to.x - from.x + from.y - to.y) / 150));
    return about(g.origin, Mat4d().setScale(Vec3d(f)));
  }
  const auto a = along_axis(g.origin, g.axis(handle), projector.ray(from));
  const auto b = along_axis(g.origin, g.axis(handle), projector.ray(to));
  if (!a || !b) return {};
  // Along one axis, the others kept: the axes are rows, so map to their coordinates, scale, map back.
  const auto row = [](const Vec3f& v) { return Vec3d(v); };
  const Vec3d x = row(g.axes.x), y = row(g.axes.y), z = row(g.axes.z);
  const Mat4d axes(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, 0, 0, 0, 1);
  Vec3d factors(1);
  factors[handle == Handle::x ? 0 : handle == Handle::y ? 1 : 2] = double(factor(*a, *b));
  return about(g.origin, axes.inverse() * Mat4d().setScale(factors) * axes);
}

}  // namespace

std::vector<GizmoLine> gizmo_lines(const Gizmo& g, const Projector& projector) {
  const float length = Gizmo::kLength * projector.metres_per_pixel(g.origin);
  std::vector<GizmoLine> lines;
  for (const Handle h : kAxes) {
    if (g.mode == GizmoMode::rotate)
      lines.push_back(line(h, projector, circle(g.origin, g.axis(h), length)));
    else
      lines.push_back(line(h, projector, {g.origin, g.origin + g.axis(h) * length}));
  }
  const float inner = g.mode == GizmoMode::rotate ? 1.15f * length : 0.12f * length;
  lines.push_back(line(Handle::all, projector, circle(g.origin, projector.to_eye(g.origin), inner)));
  return lines;
}

Handle find_handle(const Gizmo& g, const Projector& projector, const Vec2f& pointer) {
  Handle nearest = Handle::none;
  float least = Gizmo::kReach;
  for (const GizmoLine& l : gizmo_lines(g, projector)) {
    for (std::size_t i = 1; i < l.points.size(); ++i) {
      const float d = distance_to_segment(pointer, l.points[i - 1], l.points[i]);
      // At the origin, where the axes begin, it is the middle that is meant.
      if (d < least || (l.handle == Handle::all && d <= least)) {
        least = d;
        nearest = l.handle;
      }
    }
  }
  if (g.mode != GizmoMode::rotate)
    if (const auto at = projector.project(g.origin); at && (pointer - *at).length() < 0.14f * Gizmo::kLength)
      return Handle::all;
  return nearest;
}

Mat4d drag_matrix(const Gizmo& g, Handle handle, const Projector& projector, const Vec2f& from,
                  const Vec2f& to, const Snap& snap) {
  if (handle == Handle::none) return {};
  switch (g.mode) {
    case GizmoMode::translate:
      return translate(g, handle, projector.ray(from), projector.ray(to), projector.to_eye(g.origin),
                       snap.translation);
    case GizmoMode::rotate:
      return rotate(g, handle, projector, from, to, snap.rotation);
    case GizmoMode::scale:
      return scale(g, handle, projector, from, to, snap.scale);
  }
  return {};
}

}  // namespace parian::editor
