/// Where rays meet a sphere, a cylinder and a cone, seen from ever farther away: the textbook formula in
/// single precision, the robust one (Haines et al. 2019, Precision Improvements for Ray/Sphere Intersection)
/// in single precision, Parian's functions, and the same traced through its BVH, each against a formula in
/// long double.
///
/// usage: shape_stability [RAYS] > stability.csv
/// One line per solid, distance and method; RAYS (10,000,000) for each solid and distance. Lengths are in
/// units of R, the radius of the sphere, the cylinder and the cone's base; cylinder and cone are 2 R high.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

#include "renderer/accel/accel.h"
#include "renderer/base/parallel.h"
#include "renderer/base/random.h"
#include "renderer/base/sampling.h"
#include "tests/support/scenes.h"

namespace {

using namespace parian;

using Real = long double;
template <class T>
using Vec = Imath::Vec3<T>;

constexpr float kRatios[] = {1.5f, 1e1f, 1e2f, 1e3f, 1e4f, 1e5f};
constexpr std::size_t kChunk = 1 << 14;

enum Method { naive, robust, parian_function, traced, kMethods };
constexpr const char* kMethodNames[kMethods] = {"naive", "robust", "parian", "traced"};

struct Subject {
  const char* name;
  Shape shape;
  Solid solid;
  float bound;  // the radius of the ball about it
};

// The cone that a frustum is cut from: at height y its radius is middle + slope y.
template <class T>
T slope(const Frustum& f) {
  return (T(f.radius_top) - T(f.radius_bottom)) / T(f.height);
}
template <class T>
T middle(const Frustum& f) {
  return (T(f.radius_top) + T(f.radius_bottom)) / 2;
}

/// The coefficients of a t^2 + 2 b t + c, which is negative inside the infinite cone.
template <class T>
std::array<T, 3> cone_quadratic(const Frustum& f, const Vec<T>& o, const Vec<T>& d) {
  const T k = slope<T>(f), radius = middle<T>(f) + k * o.y;
  return {d.x * d.x + d.z * d.z - k * k * d.y * d.y, o.x * d.x + o.z * d.z - k * d.y * radius,
          o.x * o.x + o.z * o.z - radius * radius};
}

// The textbook, in single precision.

/// Offers a positive t that is nearer than what was found.
void offer(std::optional<float>& nearest, float t) {
  if (t > 0 && (!nearest || t < *nearest)) nearest = t;
}

std::optional<float> meet_naively(const Sphere& s, const Vec3f& o, const Vec3f& d) {
  const float a = d.dot(d), b = 2 * o.dot(d), c = o.dot(o) - s.radius * s.radius;
  const float discriminant = b * b - 4 * a * c;
  std::optional<float> nearest;
  if (discriminant < 0) return nearest;
  for (const float sign : {-1.0f, 1.0f}) offer(nearest, (-b + sign * std::sqrt(discriminant)) / (2 * a));
  return nearest;
}

std::optional<float> meet_naively(const Frustum& f, const Vec3f& o, const Vec3f& d) {
  const auto [a, half_b, c] = cone_quadratic(f, o, d);
  const float b = 2 * half_b, discriminant = b * b - 4 * a * c, half = f.height / 2;
  std::optional<float> nearest;
  if (discriminant >= 0)
    for (const float sign : {-1.0f, 1.0f}) {
      const float t = (-b + sign * std::sqrt(discriminant)) / (2 * a);
      if (std::abs(o.y + t * d.y) <= half) offer(nearest, t);
    }
  for (const float y : {-half, half}) {
    const float t = (y - o.y) / d.y, x = o.x + t * d.x, z = o.z + t * d.z;
    const float radius = y < 0 ? f.radius_bottom : f.radius_top;
    if (x * x + z * z <= radius * radius) offer(nearest, t);
  }
  return nearest;
}

// The robust formula, in single precision.

std::optional<float> first_positive(float enter, float leave) {
  if (enter > 0) return enter;
  return leave > 0 ? std::optional(leave) : std::nullopt;
}

std::optional<float> meet_robustly(const Sphere& s, const Vec3f& o, const Vec3f& d) {
  const float a = d.dot(d), b = -o.dot(d), r2 = s.radius * s.radius;
  const Vec3f nearest = o + d * (b / a);
  const float discriminant = r2 - nearest.dot(nearest);
  if (!(discriminant > 0)) return std::nullopt;
  const float c = o.dot(o) - r2, q = b + std::copysign(std::sqrt(a * discriminant), b);
  return first_positive(std::min(c / q, q / a), std::max(c / q, q / a));
}

/// The same idea for a cone: the quadratic at the point of closest approach, roots without a difference of
/// like numbers, and the part of the line between the caps' planes cut by the part inside the cone.
std::optional<float> meet_robustly(const Frustum& f, const Vec3f& o, const Vec3f& d) {
  const float shift = -o.dot(d) / d.dot(d), half = f.height / 2;
  const Vec3f n = o + d * shift;
  const auto [a, b, c] = cone_quadratic(f, n, d);
  const float discriminant = b * b - a * c;
  if (a > 0 && !(discriminant > 0)) return std::nullopt;
  const float q = -(b + std::copysign(std::sqrt(std::max(0.0f, discriminant)), b));
  float low = std::min(q / a, c / q), high = std::max(q / a, c / q);
  if (a < 0) {
    const bool widens = slope<float>(f) * d.y > 0;
    low = widens ? high : -kInfinity;
    high = widens ? kInfinity : std::min(q / a, c / q);
  }
  const float to_bottom = (-half - n.y) / d.y, to_top = (half - n.y) / d.y;
  low = std::max(low, std::min(to_bottom, to_top));
  high = std::min(high, std::max(to_bottom, to_top));
  return low < high ? first_positive(shift + low, shift + high) : std::nullopt;
}

// The reference.

/// `unsure`: rounding of long double may decide whether the line hits.
struct Truth {
  bool hit = false, unsure = false;
  Vec<Real> p{0, 0, 0};
};

/// The part of a line that is inside, from the point of closest approach on.
struct Inside {
  Real low, high, discriminant;
};

Inside find_inside(const Sphere& s, const Vec<Real>& n, const Vec<Real>& d) {
  const Real a = d.dot(d), discriminant = Real(s.radius) * s.radius - n.dot(n);
  const Real half = std::sqrt(std::max(Real(0), discriminant) / a);
  return {-half, half, discriminant};
}

Inside find_inside(const Frustum& f, const Vec<Real>& n, const Vec<Real>& d) {
  const auto [a, b, c] = cone_quadratic(f, n, d);
  const Real discriminant = b * b - a * c, root = std::sqrt(std::max(Real(0), discriminant));
  const Real t0 = (-b - root) / a, t1 = (-b + root) / a, half = Real(f.height) / 2;
  Real low = std::min(t0, t1), high = std::max(t0, t1);
  if (a < 0) {
    // Inside both nappes: what counts is the one with the solid in it, towards which the radius is positive.
    const bool widens = slope<Real>(f) * d.y > 0;
    const Real first = low, last = high;
    low = widens ? last : -std::numeric_limits<Real>::infinity();
    high = widens ? std::numeric_limits<Real>::infinity() : first;
  }
  const Real to_bottom = (-half - n.y) / d.y, to_top = (half - n.y) / d.y;
  return {std::max(low, std::min(to_bottom, to_top)), std::min(high, std::max(to_bottom, to_top)),
          discriminant};
}

Truth find_truth(const Solid& solid, const Vec3f& origin, const Vec3f& direction) {
  const Vec<Real> o(origin), d(direction);
  const Real shift = -o.dot(d) / d.dot(d);
  const Vec<Real> n = o + d * shift;
  const Inside inside = std::visit([&](const auto& s) { return find_inside(s, n, d); }, solid);
  const Real rounding = 8 * std::numeric_limits<Real>::epsilon() * (1 + o.length());
  Truth truth;
  truth.unsure = std::abs(inside.discriminant) < rounding;
  if (truth.unsure || inside.discriminant < 0) return truth;
  const Real length = inside.high - inside.low;
  truth.unsure = std::abs(length) < rounding * (1 + 1 / std::sqrt(inside.discriminant));
  truth.hit = length > 0 && shift + inside.high > 0;
  truth.p = n + d * (shift + inside.low > 0 ? inside.low : inside.high);
  return truth;
}

// What is compared.

Vec3f along(const Vec3f& o, const Vec3f& d, float t) { return o + d * t; }

/// A scene of the solid alone among specks that hardly a ray meets, so that there is a BVH to pass.
class Traced {
 public:
  explicit Traced(const Shape& shape) {
    Shape speck;
    speck.radius = 1e-6f;
    scene_.shapes = {shape, speck};
    scene_.materials.emplace_back();
    add_node(0, {});
    for (int i = 0; i < 8; ++i)
      add_node(1, translate({i & 1 ? 3.0f : -3.0f, i & 2 ? 3.0f : -3.0f, i & 4 ? 3.0f : -3.0f}));
    world_ = make_world(scene_);
    accel_.emplace(scene_, world_, AccelSettings{});
  }
  std::optional<Vec3f> meet(const Vec3f& o, const Vec3f& d) const {
    Hit hit;
    if (!accel_->intersect({o, d}, 0, hit) || !hit.is_solid() || world_.solids[hit.solid()].node != 0)
      return std::nullopt;
    return world_.solids[hit.solid()].to_world.point({hit.u, hit.v, hit.w});
  }

 private:
  void add_node(int shape, const Transform& transform) {
    Node node;
    node.shape = shape;
    node.shape_material = 0;
    node.transform = transform;
    add_root(scene_, node);
  }

  Scene scene_;
  World world_;
  std::optional<Accel> accel_;
};

std::optional<Vec3f> meet(Method method, const Solid& solid, const Traced& scene, const Vec3f& o,
                          const Vec3f& d) {
  if (method == traced) return scene.meet(o, d);
  if (method == parian_function) {
    const Vec3d start(o), direction(d);
    const std::optional<Chord> chord = intersect(solid, start, direction);
    if (!chord || !(chord->leave.t > 0)) return std::nullopt;
    const Crossing& c = chord->enter.t > 0 ? chord->enter : chord->leave;
    return project(solid, start + direction * c.t, c.face);
  }
  const std::optional<float> t = std::visit(
      [&](const auto& s) { return method == naive ? meet_naively(s, o, d) : meet_robustly(s, o, d); }, solid);
  return t ? std::optional(along(o, d, *t)) : std::nullopt;
}

struct Tally {
  std::size_t rays = 0, unsure = 0, hits = 0;
  struct {
    std::size_t false_hits = 0, false_misses = 0, both = 0, beyond = 0;
    double sum = 0, worst = 0;
  } of[kMethods];

  void add(Method method, const Truth& truth, const std::optional<Vec3f>& p) {
    auto& m = of[method];
    m.false_hits += p && !truth.hit;
    m.false_misses += !p && truth.hit;
    if (!p || !truth.hit) return;
    const Vec<Real> difference = Vec<Real>(*p) - truth.p;
    const double error = double(std::sqrt(difference.dot(difference)));
    ++m.both;
    m.sum += error;
    m.worst = std::max(m.worst, error);
    m.beyond += error > double(solid_offset(Affine{}, *p));
  }
  void add(const Tally& other) {
    rays += other.rays;
    unsure += other.unsure;
    hits += other.hits;
    for (int i = 0; i < kMethods; ++i) {
      of[i].false_hits += other.of[i].false_hits;
      of[i].false_misses += other.of[i].false_misses;
      of[i].both += other.of[i].both;
      of[i].beyond += other.of[i].beyond;
      of[i].sum += other.of[i].sum;
      of[i].worst = std::max(of[i].worst, other.of[i].worst);
    }
  }
};

/// A SplitMix64 sequence (Steele et al. 2014): a renderer's 32 bits are too few for so many rays.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed << 32) {}
  float next() {
    std::uint64_t x = state_ += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return to_unit_float(std::uint32_t((x ^ (x >> 31)) >> 32));
  }
  Vec2f next2() {
    const float x = next();
    return {x, next()};
  }

 private:
  std::uint64_t state_;
};

Tally trace_chunk(const Subject& subject, const Traced& scene, float ratio, std::size_t rays,
                  std::uint64_t seed) {
  Numbers numbers(seed);
  Tally tally;
  for (std::size_t i = 0; i < rays; ++i) {
    const Vec3f o = sample_sphere(numbers.next2()) * ratio;
    // Somewhere in a ball about the solid: hits and misses are both common.
    const Vec3f direction = sample_sphere(numbers.next2());
    const Vec3f to = direction * (std::cbrt(numbers.next()) * 1.3f * subject.bound) - o;
    const Vec3f d = to / to.length();
    const Truth truth = find_truth(subject.solid, o, d);
    ++tally.rays;
    tally.unsure += truth.unsure;
    if (truth.unsure) continue;
    tally.hits += truth.hit;
    for (const Method method : {naive, robust, parian_function, traced})
      tally.add(method, truth, meet(method, subject.solid, scene, o, d));
  }
  return tally;
}

void print(const Subject& subject, float ratio, const Tally& tally) {
  const double sure = double(tally.rays - tally.unsure);
  for (int i = 0; i < kMethods; ++i) {
    const auto& m = tally.of[i];
    fmt::print("{},{:g},{},{},{},{:.4f},{},{},{:.3e},{:.3e},{:.3e},{:.3e}\n", subject.name, ratio,
               kMethodNames[i], tally.rays, tally.unsure, double(tally.hits) / sure, m.false_hits,
               m.false_misses, double(m.false_hits + m.false_misses) / sure, m.worst,
               m.sum / double(std::max<std::size_t>(1, m.both)),
               double(m.beyond) / double(std::max<std::size_t>(1, m.both)));
  }
  std::fflush(stdout);
}

std::vector<Subject> subjects() {
  const Shape sphere = make_sphere(1), cylinder = make_cylinder(1, 1, 2), cone = make_cylinder(1, 0, 2);
  const float bound = std::sqrt(2.0f);
  return {{"sphere", sphere, Sphere{1}, 1},
          {"cylinder", cylinder, Frustum{1, 1, 2}, bound},
          {"cone", cone, Frustum{1, 0, 2}, bound}};
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t rays = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10'000'000;
  if (rays == 0) {
    fmt::print(stderr, "usage: {} [RAYS]\n", argv[0]);
    return 2;
  }
  fmt::print(
      "shape,ratio,method,rays,left_out,hit_share,false_hits,false_misses,wrong_share,max_error,"
      "mean_error,beyond_bound_share\n");
  std::uint64_t seed = 0;
  for (const Subject& subject : subjects()) {
    const Traced scene(subject.shape);
    for (const float ratio : kRatios) {
      std::vector<Tally> tallies((rays + kChunk - 1) / kChunk);
      parallel_for(tallies.size(), 1, [&](std::size_t i) {
        const std::size_t count = std::min(kChunk, rays - i * kChunk);
        tallies[i] = trace_chunk(subject, scene, ratio, count, seed + i);
      });
      seed += tallies.size();
      Tally sum;
      for (const Tally& tally : tallies) sum.add(tally);
      print(subject, ratio, sum);
    }
  }
  return 0;
}
