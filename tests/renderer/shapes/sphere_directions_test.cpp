// Directions to a sphere: density, and stability from far away, from inside and on the surface.
#include <gtest/gtest.h>

#include "renderer/base/random.h"
#include "renderer/shapes/sphere.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

Vec2f number(std::uint32_t i) { return {to_unit_float(hash32(i, 21)), to_unit_float(hash32(i, 22))}; }

const Vec3f kCenter(0.3f, -0.4f, 0.2f);
constexpr float kRadius = 0.7f;

TEST(SphereDirections, FollowTheirDensity) {
  const Vec3f away = normalize(Vec3f(1, 2, -0.5f));
  for (const float ratio : {0.0f, 0.5f, 0.99f, 1.01f, 1.3f, 4.0f, 30.0f}) {
    const Vec3f p = kCenter + away * (ratio * kRadius);
    std::uint32_t i = 0;
    const auto sample = [&]() -> std::optional<Vec3f> {
      const auto s = sample_directions(kCenter, kRadius, p, number(i++));
      return s ? std::optional(s->w) : std::nullopt;
    };
    const auto pdf = [&](const Vec3f& w) {
      const auto chord = intersect(Sphere{kRadius}, Vec3d(p - kCenter), Vec3d(w));
      return chord && chord->leave.t > 0 ? pdf_directions(kCenter, kRadius, p) : 0.0f;
    };
    SphereCells cells;
    cells.axis = -away;
    cells.zoom = ratio > 2 ? 0.5 / (ratio * ratio) : 100;
    cells.tolerance = 1e-5;
    EXPECT_TRUE(samples_directions(sample, pdf, cells, 50000, 7)) << ratio;
  }
}

// In double the solid angle is known; a density from 1 - cos is 7% off at 10^3 and infinite at 10^4.
TEST(SphereDirections, DensityIsExactFarAway) {
  for (const double ratio : {1.5, 1e1, 1e2, 1e3, 1e4, 1e5, 1e8}) {
    const auto p = Vec3f(Vec3d(ratio, 0, 0));
    const double s = 1 / double(p.x), solid_angle = 2 * std::numbers::pi * s * s / (1 + std::sqrt(1 - s * s));
    EXPECT_NEAR(pdf_directions({0, 0, 0}, 1, p) * solid_angle, 1, 1e-5) << ratio;
  }
}

// The point that goes with a direction is where the direction meets the sphere, and is on the near side.
TEST(SphereDirections, NormalsAreWhereTheDirectionArrives) {
  for (const float ratio : {0.0f, 0.3f, 0.9f, 1.0f, 1.0005f, 1.01f, 2.0f, 1e3f, 1e4f})
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const Vec3f p = kCenter + normalize(Vec3f(-1, 0.5f, 2)) * (ratio * kRadius);
      const auto s = sample_directions(kCenter, kRadius, p, number(i));
      if (!s) continue;
      ASSERT_TRUE(is_finite(s->w) && is_finite(s->normal) && s->pdf > 0 && s->pdf < kInfinity);
      EXPECT_NEAR(s->normal.length(), 1, 1e-5);
      const Vec3d from = Vec3d(kCenter) + Vec3d(s->normal) * kRadius - Vec3d(p);
      // Across the line of the direction, in radii; rounding of the direction alone is ratio * 6e-8.
      const double off = from.cross(Vec3d(s->w)).length() / kRadius;
      EXPECT_LT(off, 3e-6 + 2e-7 * ratio) << ratio << " " << i;
      EXPECT_GT(from.dot(Vec3d(s->w)), 0) << ratio;
      if (ratio > 1.0001f) {
        EXPECT_LT(s->w.dot(s->normal), 1e-3f) << ratio;
      }
    }
}

// Of a point on the surface itself, rounded to one side or the other: the opposite side of the sphere is
// seen.
TEST(SphereDirections, APointOnTheSurfaceSeesTheOtherSide) {
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const Vec3f n = normalize(Vec3f(Vec3d(std::sin(i), std::cos(2.0 * i), std::cos(i))));
    const Vec3f p = kCenter + n * kRadius;
    const auto s = sample_directions(kCenter, kRadius, p, number(i));
    EXPECT_FLOAT_EQ(pdf_directions(kCenter, kRadius, p), 0.25f * kInvPi);
    if (!s) continue;
    EXPECT_FLOAT_EQ(s->pdf, 0.25f * kInvPi);
    if (s->w.dot(n) < -0.01f) {
      // The chord from the surface has the length 2 R cos.
      const float length = (kCenter + s->normal * kRadius - p).length();
      EXPECT_NEAR(length, 2 * kRadius * -s->w.dot(n), 1e-4f);
    }
  }
}

}  // namespace
}  // namespace parian
