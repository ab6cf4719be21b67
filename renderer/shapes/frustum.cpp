#include "renderer/shapes/frustum.h"

#include <array>

#include "renderer/base/sampling.h"

namespace parian {
namespace {

double slope(const Frustum& f) { return (double(f.radius_top) - f.radius_bottom) / f.height; }
double mean_radius(const Frustum& f) { return 0.5 * (double(f.radius_top) + f.radius_bottom); }

/// The part of a line that is left of it: clipped from both ends.
struct Span {
  Chord chord{{-std::numeric_limits<double>::infinity(), Face::side},
              {std::numeric_limits<double>::infinity(), Face::side}};

  void after(double t, Face face) {
    if (t > chord.enter.t) chord.enter = {t, face};
  }
  void before(double t, Face face) {
    if (t < chord.leave.t) chord.leave = {t, face};
  }
  bool empty() const { return !(chord.enter.t < chord.leave.t); }
};

/// Keeps what lies in the cone: a t^2 + 2 b t + c < 0. `widens`: the radius grows along the line. False where
/// nothing is left.
bool clip_cone(Span& span, double a, double b, double c, bool widens) {
  if (a == 0) {
    // Parallel to a generator (or to the axis of a cylinder, where b is 0 too): one end is at infinity.
    if (b == 0) return c < 0;
    const double t = -c / (2 * b);
    b > 0 ? span.before(t, Face::side) : span.after(t, Face::side);
    return true;
  }
  const double discriminant = b * b - a * c;
  if (a > 0 && !(discriminant > 0)) return false;
  const double q = -(b + std::copysign(std::sqrt(std::max(0.0, discriminant)), b));
  // q is 0 only at a line through the apex.
  const double t0 = q / a, t1 = q == 0 ? 0 : c / q;
  const double low = std::min(t0, t1), high = std::max(t0, t1);
  if (a > 0) {
    span.after(low, Face::side);
    span.before(high, Face::side);
  } else if (widens) {
    // Steeper than the generators: inside both nappes, and the solid is in the one that widens from radius 0.
    span.after(high, Face::side);
  } else {
    span.before(low, Face::side);
  }
  return true;
}

struct Areas {
  float side, top, bottom;
};

Areas areas(const Frustum& f) {
  const float difference = f.radius_top - f.radius_bottom;
  return {kPi * (f.radius_bottom + f.radius_top) * std::hypot(f.height, difference),
          kPi * f.radius_top * f.radius_top, kPi * f.radius_bottom * f.radius_bottom};
}

}  // namespace

std::optional<Chord> intersect(const Frustum& f, const Vec3d& o, const Vec3d& d) {
  const double shift = -o.dot(d) / d.dot(d);
  const Vec3d n = o + d * shift;
  const double half = 0.5 * f.height, k = slope(f), radius = mean_radius(f) + k * n.y;

  Span span;
  if (d.y != 0) {
    const double scale = 1 / d.y, to_bottom = (-half - n.y) * scale, to_top = (half - n.y) * scale;
    const bool up = d.y > 0;
    span.after(up ? to_bottom : to_top, up ? Face::bottom : Face::top);
    span.before(up ? to_top : to_bottom, up ? Face::top : Face::bottom);
  } else if (!(std::abs(n.y) < half)) {
    return std::nullopt;
  }
  const double a = d.x * d.x + d.z * d.z - k * k * d.y * d.y;
  const double b = n.x * d.x + n.z * d.z - k * d.y * radius;
  const double c = n.x * n.x + n.z * n.z - radius * radius;
  if (!clip_cone(span, a, b, c, k * d.y > 0) || span.empty()) return std::nullopt;
  span.chord.enter.t += shift;
  span.chord.leave.t += shift;
  return span.chord;
}

Vec3f project(const Frustum& f, const Vec3d& p, Face face) {
  const double half = 0.5 * f.height, across = std::sqrt(p.x * p.x + p.z * p.z);
  if (face == Face::side) {
    const double y = std::clamp(p.y, -half, half), radius = std::max(0.0, mean_radius(f) + slope(f) * y);
    if (across == 0) return Vec3f(Vec3d(0, y, radius));
    return Vec3f(Vec3d(p.x * (radius / across), y, p.z * (radius / across)));
  }
  const double radius = face == Face::top ? f.radius_top : f.radius_bottom;
  const double scale = across > radius ? radius / across : 1;
  return Vec3f(Vec3d(p.x * scale, face == Face::top ? half : -half, p.z * scale));
}

SolidPoint surface_point(const Frustum& f, const Vec3f& p, Face face) {
  if (face == Face::side) {
    const float across = std::sqrt(p.x * p.x + p.z * p.z), k = float(slope(f));
    const Vec2f uv(0.5f + angle_of(p.z, p.x) * (0.5f * kInvPi),
                   std::clamp(0.5f - p.y / f.height, 0.0f, 1.0f));
    if (!(across > 0)) return {{0, p.y > 0 ? 1.0f : -1.0f, 0}, uv, {0, 0, 0}};
    return {normalize(Vec3f(p.x / across, -k, p.z / across)), uv, {p.z, 0, -p.x}};
  }
  const float up = face == Face::top ? 1.0f : -1.0f;
  const float radius = face == Face::top ? f.radius_top : f.radius_bottom;
  const float scale = radius > 0 ? 0.5f / radius : 0;  // 0: an apex
  return {{0, up, 0}, {0.5f + p.x * scale, 0.5f + up * p.z * scale}, {1, 0, 0}};
}

Box3d extent(const Frustum& f, const Affine& map) {
  const Vec3d x(map.x), z(map.z), top = Vec3d(map.y) * (0.5 * f.height);
  const auto along = [&](int i) { return std::sqrt(x[i] * x[i] + z[i] * z[i]); };
  const Vec3d disk(along(0), along(1), along(2));
  // The solid is the convex hull of its two caps.
  Box3d box(top - disk * f.radius_top, top + disk * f.radius_top);
  box.extendBy(Box3d(-top - disk * f.radius_bottom, -top + disk * f.radius_bottom));
  return box;
}

float area(const Frustum& f) {
  const Areas a = areas(f);
  return a.side + a.top + a.bottom;
}

double area(const Frustum& f, const Affine& map) {
  constexpr int kSteps = 256;
  const Affined m{Vec3d(map.x), Vec3d(map.y), Vec3d(map.z), {0, 0, 0}};
  const double k = slope(f), length = std::sqrt(1 + k * k);
  double side = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double phi = 2 * std::numbers::pi * i / kSteps;
    side += m.normal(Vec3d(std::cos(phi), -k, std::sin(phi)) / length).length();
  }
  const Areas a = areas(f);
  return side / kSteps * a.side + m.normal({0, 1, 0}).length() * (double(a.top) + a.bottom);
}

SurfaceSample sample_surface(const Frustum& f, const Vec2f& u) {
  const Areas a = areas(f);
  float x = u.x * (a.side + a.top + a.bottom);
  if (x < a.side) {
    // The height whose share of the side is below it (a quadratic, its root without a difference).
    x /= a.side;
    const float b = f.radius_bottom, t = f.radius_top;
    const float root = b + std::sqrt(std::max(0.0f, b * b + x * (t * t - b * b)));
    const float share = root > 0 ? std::min(1.0f, x * (b + t) / root) : 0;
    const Vec2f circle = unit_circle(u.y) * (b + (t - b) * share);
    return {{circle.x, (share - 0.5f) * f.height, circle.y}, Face::side};
  }
  x -= a.side;
  const bool top = x < a.top;
  const float radius = top ? f.radius_top : f.radius_bottom;
  const float share = std::clamp(top ? x / a.top : (x - a.top) / a.bottom, 0.0f, 1.0f);
  const Vec2f q = sample_disk({share, u.y}) * radius;
  return {{q.x, top ? 0.5f * f.height : -0.5f * f.height, q.y}, top ? Face::top : Face::bottom};
}

}  // namespace parian
