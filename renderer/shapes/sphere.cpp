#include "renderer/shapes/sphere.h"

#include "renderer/base/sampling.h"

namespace parian {
namespace {

// Within this share of the radius from the surface no cone is sampled: the shading point of a light sample
// and the origin of a ray that finds the light differ by rounding, and both must choose alike.
constexpr float kBand = 1e-3f;

bool has_cone(float radius, float distance) { return distance > radius * (1 + kBand); }

/// 1 - cos of the half angle of the cone in which a sphere is seen.
float cone(float radius, float distance) {
  const float sine = radius / distance, sine2 = sine * sine;
  return sine2 / (1 + std::sqrt(1 - sine2));
}

/// Where a line from p, inside or next to the surface, first meets the sphere.
std::optional<Vec3f> first_normal(const Vec3f& from_center, float radius, const Vec3f& w) {
  // A point on the surface itself, but for rounding, sees what is opposite.
  constexpr double kSelf = 1e-5;
  const std::optional<Chord> chord = intersect(Sphere{radius}, Vec3d(from_center), Vec3d(w));
  if (!chord) return std::nullopt;
  const double least = kSelf * radius;
  const double t = chord->enter.t > least ? chord->enter.t : chord->leave.t;
  if (!(t > least)) return std::nullopt;
  return Vec3f((Vec3d(from_center) + Vec3d(w) * t).normalized());
}

}  // namespace

Vec3f project(const Sphere& s, const Vec3d& p, Face) { return Vec3f(p * (s.radius / p.length())); }

SolidPoint surface_point(const Sphere& s, const Vec3f& p, Face) {
  const Vec3f n = p / s.radius;
  const float across = std::sqrt(n.x * n.x + n.z * n.z);
  return {normalize(n),
          {0.5f + angle_of(n.z, n.x) * (0.5f * kInvPi), angle_of(n.y, across) * kInvPi},
          {n.z, 0, -n.x}};
}

Box3d extent(const Sphere& s, const Affine& map) {
  const Vec3d x(map.x), y(map.y), z(map.z);
  const auto along = [&](int i) { return s.radius * std::sqrt(x[i] * x[i] + y[i] * y[i] + z[i] * z[i]); };
  const Vec3d half(along(0), along(1), along(2));
  return {-half, half};
}

float area(const Sphere& s) { return 4 * kPi * s.radius * s.radius; }

double area(const Sphere& s, const Affine& map) {
  constexpr int kSteps = 64;
  const Affined m{Vec3d(map.x), Vec3d(map.y), Vec3d(map.z), {0, 0, 0}};
  double sum = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double y = -1 + (2 * i + 1.0) / kSteps, phi = std::numbers::pi * (2 * j + 1.0) / kSteps;
      const double across = std::sqrt(1 - y * y);
      sum += m.normal({across * std::cos(phi), y, across * std::sin(phi)}).length();
    }
  return sum / (kSteps * kSteps) * 4 * std::numbers::pi * s.radius * s.radius;
}

SurfaceSample sample_surface(const Sphere& s, const Vec2f& u) {
  return {sample_sphere(u) * s.radius, Face::side};
}

std::optional<SphereDirection> sample_directions(const Vec3f& center, float radius, const Vec3f& p,
                                                 const Vec2f& u) {
  const Vec3f to_center = center - p;
  const float distance = to_center.length();
  if (!has_cone(radius, distance)) {
    const Vec3f w = sample_sphere(u);
    const std::optional<Vec3f> normal = first_normal(-to_center, radius, w);
    if (!normal) return std::nullopt;
    return SphereDirection{w, 0.25f * kInvPi, *normal};
  }
  const float sine = radius / distance, whole = cone(radius, distance);
  const float below = u.x * whole;  // 1 - cos of the angle to the centre
  const float sin2 = below * (2 - below), cosine = 1 - below;
  // The angle at the centre between p and the point that the direction meets, by the law of sines: that at
  // the point, whose sine is `share`, less that at p. Both forms are exact to rounding.
  const float share = std::min(1.0f, std::sqrt(sin2) / sine), across = std::sqrt(1 - share * share);
  const float cos_alpha = across * cosine + share * std::sqrt(sin2);
  const float sin_alpha = std::max(0.0f, share * cosine - across * std::sqrt(sin2));
  const Frame frame = make_frame(to_center / distance);
  const Vec2f circle = unit_circle(u.y);
  const Vec3f w = frame.to_world(Vec3f(circle.x, circle.y, 0) * std::sqrt(sin2) + Vec3f(0, 0, cosine));
  const Vec3f n = frame.to_world({circle.x * sin_alpha, circle.y * sin_alpha, -cos_alpha});
  return SphereDirection{w, 1 / (2 * kPi * whole), n};
}

float pdf_directions(const Vec3f& center, float radius, const Vec3f& p) {
  const float distance = (center - p).length();
  return has_cone(radius, distance) ? 1 / (2 * kPi * cone(radius, distance)) : 0.25f * kInvPi;
}

}  // namespace parian
