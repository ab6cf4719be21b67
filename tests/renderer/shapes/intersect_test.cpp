// Where lines cross the solids: against long double over distance, and every degenerate line.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "renderer/base/random.h"
#include "renderer/base/sampling.h"
#include "renderer/shapes/solid.h"

namespace parian {
namespace {

using Real = long double;

struct NamedSolid {
  const char* name;
  Solid solid;
};

std::vector<NamedSolid> solids() {
  return {{"sphere", Sphere{1}},
          {"cylinder", Frustum{0.8f, 0.8f, 1.2f}},
          {"cone", Frustum{0.9f, 0, 1.3f}},
          {"cone on its apex", Frustum{0, 0.5f, 2}},
          {"frustum", Frustum{0.7f, 0.3f, 1}},
          {"disk", Frustum{1, 1, 1e-3f}},
          {"needle", Frustum{1e-3f, 2e-3f, 2}}};
}

/// How far inside the solid a point is, as the least of its distances to the faces; negative outside.
Real depth(const Sphere& s, const std::array<Real, 3>& p) {
  return s.radius - std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}
Real depth(const Frustum& f, const std::array<Real, 3>& p) {
  const Real k = (Real(f.radius_top) - f.radius_bottom) / f.height;
  const Real radius = 0.5L * (Real(f.radius_top) + f.radius_bottom) + k * p[1];
  const Real side = (radius - std::sqrt(p[0] * p[0] + p[2] * p[2])) / std::sqrt(1 + k * k);
  return std::min(side, 0.5L * f.height - std::abs(p[1]));
}
Real depth(const Solid& solid, const std::array<Real, 3>& p) {
  return std::visit([&](const auto& s) { return depth(s, p); }, solid);
}

std::array<Real, 3> at(const Vec3d& o, const Vec3d& d, Real t) {
  return {o.x + t * d.x, o.y + t * d.y, o.z + t * d.z};
}

/// The t between a and b where the depth is largest. It is concave, the solids being convex.
Real deepest(const Solid& solid, const Vec3d& o, const Vec3d& d, Real a, Real b) {
  for (int i = 0; i < 200; ++i) {
    const Real m = a + (b - a) / 3, n = b - (b - a) / 3;
    (depth(solid, at(o, d, m)) < depth(solid, at(o, d, n)) ? a : b) =
        depth(solid, at(o, d, m)) < depth(solid, at(o, d, n)) ? m : n;
  }
  return 0.5L * (a + b);
}

/// The t between `inside` and `outside` where the depth is 0.
Real border(const Solid& solid, const Vec3d& o, const Vec3d& d, Real inside, Real outside) {
  for (int i = 0; i < 200; ++i) {
    const Real m = 0.5L * (inside + outside);
    (depth(solid, at(o, d, m)) > 0 ? inside : outside) = m;
  }
  return inside;
}

float size_of(const Solid& solid) {
  const Box3f box = bounds(solid, Affine{});
  return 0.5f * box.size().length();
}

class Numbers {
 public:
  float next() { return to_unit_float(hash32(++count_, 77)); }
  Vec2f next2() {
    const float x = next();
    return {x, next()};
  }
  Vec3f in_ball() { return sample_sphere(next2()) * std::cbrt(next()); }

 private:
  std::uint32_t count_ = 0;
};

// The reference knows no quadratic: it looks for where the depth of the point changes its sign, so
// a wrong formula cannot agree with it by sharing its mistake. Caught: the naive discriminant from 100 radii
// on, a missing cap, the wrong nappe, an unstable root.
TEST(SolidIntersect, AgreesWithASearchInLongDoubleAtEveryDistance) {
  Numbers numbers;
  for (const auto& [name, solid] : solids())
    for (const float ratio : {0.0f, 1.5f, 1e2f, 1e3f, 1e4f, 1e5f, 1e6f}) {
      const float size = size_of(solid);
      int hits = 0, wrong = 0;
      double worst = 0;
      constexpr int kRays = 1500;
      for (int i = 0; i < kRays; ++i) {
        const Vec3f o = ratio == 0 ? Vec3f(project(solid, Vec3d(numbers.in_ball()), Face::side)) * 0.5f
                                   : sample_sphere(numbers.next2()) * (ratio * size);
        // In the image of a ball about the bounds: some rays miss, whatever the solid's proportions.
        const Vec3f to = numbers.in_ball() * bounds(solid, Affine{}).max * 1.4f;
        if (to == o) continue;
        const Vec3d start(o), d(normalize(to - o));
        const Real middle = (Vec3d(to) - start).length();
        const Real reach = middle + 4 * Real(size), back = middle - 4 * Real(size);
        const Real deep = deepest(solid, start, d, back, reach);
        const Real most = depth(solid, at(start, d, deep));
        const auto chord = intersect(solid, start, d);
        if (std::abs(most) < 1e-9L * size) continue;  // tangent but for rounding of the reference itself
        wrong += chord.has_value() != (most > 0);
        if (!chord || most <= 0) continue;
        ++hits;
        EXPECT_LT(chord->enter.t, chord->leave.t);
        const Real enter = border(solid, start, d, deep, back), leave = border(solid, start, d, deep, reach);
        for (const auto& [crossing, truth] : {std::pair{chord->enter, enter}, {chord->leave, leave}}) {
          worst = std::max(worst, double(std::abs(crossing.t - truth)) / size);
          // The point lies on the face that is named.
          const Vec3f p = project(solid, start + d * crossing.t, crossing.face);
          const auto exact = at(start, d, truth);
          worst = std::max(
              worst,
              (Vec3d(p) - Vec3d(double(exact[0]), double(exact[1]), double(exact[2]))).length() / size);
        }
      }
      EXPECT_EQ(wrong, 0) << name << " at " << ratio;
      EXPECT_GT(hits, kRays / 20) << name << " at " << ratio;
      // Single precision: half a unit in the last place of the point; grazing rays magnify what the origin's
      // distance costs even double precision.
      EXPECT_LT(worst, 2e-7 + 1e-11 * ratio) << name << " at " << ratio;
    }
}

void expect_sound(const Solid& solid, const Vec3d& o, const Vec3d& d, const std::string& what) {
  const auto chord = intersect(solid, o, d);
  if (!chord) return;
  ASSERT_TRUE(std::isfinite(chord->enter.t) && std::isfinite(chord->leave.t)) << what;
  EXPECT_LE(chord->enter.t, chord->leave.t) << what;
  for (const Crossing& c : {chord->enter, chord->leave}) {
    const Vec3f p = project(solid, o + d * c.t, c.face);
    ASSERT_TRUE(is_finite(p)) << what;
    const SolidPoint point = surface_point(solid, p, c.face);
    EXPECT_TRUE(is_finite(point.normal) && is_finite(point.dpdu)) << what;
    EXPECT_NEAR(point.normal.length(), 1, 1e-5) << what;
    EXPECT_TRUE(point.uv.x >= 0 && point.uv.x <= 1 && point.uv.y >= 0 && point.uv.y <= 1)
        << what << ": " << point.uv;
    EXPECT_LT(std::abs(double(depth(solid, at(o, d, c.t)))), 1e-6 * size_of(solid)) << what;
  }
}

// Lines along the axes, along generators, through apex and rims, tangent, from on and inside the
// surface, on a grid of origins and directions where all of these meet.
TEST(SolidIntersect, DegenerateLinesGiveNoNaN) {
  for (const auto& [name, solid] : solids()) {
    const Box3f box = bounds(solid, Affine{});
    const Vec3f half = box.max;
    std::vector<Vec3d> points;
    for (const float x : {-2.0f, -1.0f, -0.5f, 0.0f, 1.0f})
      for (const float y : {-3.0f, -1.0f, 0.0f, 1.0f})
        for (const float z : {-1.0f, 0.0f, 0.25f, 1.0f})
          points.push_back(Vec3d(x * half.x, y * half.y, z * half.z));
    for (int i = 0; i < 8; ++i)
      for (const Face face : {Face::side, Face::top, Face::bottom})
        points.push_back(Vec3d(project(solid, Vec3d(std::cos(i), 0.3 * i - 1, std::sin(i)), face)));
    for (const Vec3d& o : points) {
      for (const Vec3d& to : points) {
        if (o == to) continue;
        expect_sound(solid, o, to - o, name);
        expect_sound(solid, o, (to - o) * 1e-6, name);
      }
      for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {1.0, -1.0, 1e-30, -1e30}) {
          Vec3d d(0);
          d[axis] = sign;
          expect_sound(solid, o, d, name);
          d[(axis + 1) % 3] = sign * 1e-17;
          expect_sound(solid, o, d, name);
        }
    }
  }
}

// A line along a generator of the cone lies outside, and one shifted inwards crosses side and cap.
TEST(SolidIntersect, LinesParallelToAGeneratorCrossOnce) {
  const Frustum cone{1, 0, 1};
  const Vec3d generator(-1, 1, 0);  // from the rim at (1, -.5, 0) to the apex at (0, .5, 0)
  for (const double inwards : {0.5, 1e-3, 1e-8}) {
    const auto chord = intersect(cone, {1 - inwards, -0.5, 0}, generator);
    ASSERT_TRUE(chord);
    EXPECT_EQ(chord->enter.face, Face::bottom);
    EXPECT_EQ(chord->leave.face, Face::side);
    EXPECT_NEAR(chord->enter.t, 0, 1e-12);
    // Where it meets the opposite generator x = y - .5.
    EXPECT_NEAR(chord->leave.t, 1 - 0.5 * inwards, 1e-7);
  }
  EXPECT_FALSE(intersect(cone, {1.001, -0.5, 0}, generator));
}

// Steeper than the generators, a line is in both nappes: only that of the solid counts.
TEST(SolidIntersect, TheSecondNappeIsNotThere) {
  const Frustum cone{1, 0, 1};
  EXPECT_FALSE(intersect(cone, {0, 2, 0}, {0, 1e-3, 1}));  // across the mirrored cone above the apex
  const auto chord = intersect(cone, {0.1, 5, 0}, {0, -1, 0});
  ASSERT_TRUE(chord);
  EXPECT_NEAR(5 - chord->enter.t, 0.4, 1e-12);
  EXPECT_NEAR(5 - chord->leave.t, -0.5, 1e-12);
  EXPECT_EQ(chord->enter.face, Face::side);
  EXPECT_EQ(chord->leave.face, Face::bottom);
}

TEST(SolidIntersect, AlongTheAxisOfACylinderOnlyCapsAreCrossed) {
  const Frustum cylinder{1, 1, 2};
  const auto chord = intersect(cylinder, {0.5, -7, 0}, {0, 2, 0});
  ASSERT_TRUE(chord);
  EXPECT_EQ(chord->enter.face, Face::bottom);
  EXPECT_EQ(chord->leave.face, Face::top);
  EXPECT_DOUBLE_EQ(chord->enter.t, 3);
  EXPECT_DOUBLE_EQ(chord->leave.t, 4);
  EXPECT_FALSE(intersect(cylinder, {1.5, -7, 0}, {0, 2, 0}));
}

// The unit of t is the length of d, whatever that is.
TEST(SolidIntersect, DirectionsNeedNoUnitLength) {
  for (const auto& [name, solid] : solids()) {
    const Vec3d o(0.1, 3, 0.05), d(0.01, -1, 0.002);
    const auto one = intersect(solid, o, d), other = intersect(solid, o, d * 1e-4);
    ASSERT_EQ(one.has_value(), other.has_value()) << name;
    if (!one) continue;
    EXPECT_NEAR(one->enter.t, other->enter.t * 1e-4, 1e-10) << name;
    EXPECT_NEAR(one->leave.t, other->leave.t * 1e-4, 1e-10) << name;
  }
}

}  // namespace
}  // namespace parian
