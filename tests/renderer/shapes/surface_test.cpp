// The surface of the solids: normals, coordinates, areas and uniform points.
#include <gtest/gtest.h>

#include "renderer/base/random.h"
#include "renderer/shapes/solid.h"
#include "tests/support/chi_square.h"

namespace parian {
namespace {

const std::vector<Solid> kSolids = {Sphere{0.7f}, Frustum{0.8f, 0.8f, 1.2f}, Frustum{0.9f, 0, 1.3f},
                                    Frustum{0, 0.5f, 2}, Frustum{0.7f, 0.3f, 1}};

Affine stretched() { return {{2, 0.3f, 0.1f}, {-0.4f, 0.5f, 0.2f}, {0.3f, 0.7f, -1.5f}, {3, -2, 5}}; }

// The normal is across the surface: a point moved along it leaves, one moved against it is inside.
TEST(SolidSurface, NormalsPointOutwards) {
  for (const Solid& solid : kSolids)
    for (int i = 0; i < 1000; ++i) {
      const Vec2f u(to_unit_float(hash32(i, 1)), to_unit_float(hash32(i, 2)));
      const SurfaceSample s = sample_surface(solid, u);
      const SolidPoint point = surface_point(solid, s.p, s.face);
      EXPECT_NEAR(point.normal.length(), 1, 1e-6);
      const auto chord = intersect(solid, Vec3d(s.p) + Vec3d(point.normal) * 0.01, -Vec3d(point.normal));
      ASSERT_TRUE(chord) << s.p;
      EXPECT_NEAR(chord->enter.t, 0.01, 1e-6) << s.p;
      EXPECT_NEAR(point.normal.dot(point.dpdu), 0, 1e-6);
      // What lies beside the point on the surface lies in its tangent plane, but for the curvature.
      const Frame frame = make_frame(point.normal);
      for (const Vec3f& step : {frame.x, frame.y}) {
        const Vec3f beside = project(solid, Vec3d(s.p + step * 1e-3f), s.face);
        const float radius = std::hypot(s.p.x, s.p.z);
        if (s.face == Face::side && (radius < 0.05f || point.uv.y < 0.01f || point.uv.y > 0.99f)) continue;
        EXPECT_LT(std::abs((beside - s.p).dot(point.normal)), 3e-5f) << s.p;
      }
    }
}

// u and v by finite differences: dpdu is where u grows, v grows against n x dpdu, so that a texture seen from
// outside is not mirrored.
TEST(SolidSurface, TexturesAreNotMirrored) {
  for (const Solid& solid : kSolids)
    for (int i = 0; i < 500; ++i) {
      const Vec2f u(to_unit_float(hash32(i, 3)), to_unit_float(hash32(i, 4)));
      const SurfaceSample s = sample_surface(solid, u);
      const SolidPoint here = surface_point(solid, s.p, s.face);
      const float dpdu_length = here.dpdu.length();
      if (dpdu_length < 0.05f || here.uv.x < 0.02f || here.uv.x > 0.98f) continue;
      const float step = 2e-3f;
      const Vec3f right = here.dpdu / dpdu_length, up = here.normal.cross(right);
      const auto uv_at = [&](const Vec3f& p) {
        return surface_point(solid, project(solid, Vec3d(p), s.face), s.face).uv;
      };
      const Vec2f along = uv_at(s.p + right * step) - here.uv, above = uv_at(s.p + up * step) - here.uv;
      EXPECT_GT(along.x, 0) << s.p;
      if (here.uv.y > 0.01f && here.uv.y < 0.99f) {
        EXPECT_LT(above.y, 0) << s.p;
      }
    }
}

TEST(SolidSurface, CoordinatesLieWhereTheyAreDocumented) {
  const auto near = [](const Vec2f& a, const Vec2f& b) { return (a - b).length() < 1e-5f; };
  const Sphere sphere{2};
  EXPECT_TRUE(near(surface_point(sphere, {0, 0, 2}, Face::side).uv, {0.5f, 0.5f}));
  EXPECT_TRUE(near(surface_point(sphere, {2, 0, 0}, Face::side).uv, {0.75f, 0.5f}));
  EXPECT_TRUE(near(surface_point(sphere, {-2, 0, 0}, Face::side).uv, {0.25f, 0.5f}));
  EXPECT_NEAR(surface_point(sphere, {0, 2, 0}, Face::side).uv.y, 0, 1e-5);
  EXPECT_NEAR(surface_point(sphere, {0, -2, 0}, Face::side).uv.y, 1, 1e-5);
  const Frustum f{2, 1, 4};
  EXPECT_TRUE(near(surface_point(f, {0, 2, 1}, Face::side).uv, {0.5f, 0}));
  EXPECT_TRUE(near(surface_point(f, {2, -2, 0}, Face::side).uv, {0.75f, 1}));
  EXPECT_TRUE(near(surface_point(f, {1, 2, 0}, Face::top).uv, {1, 0.5f}));
  EXPECT_TRUE(near(surface_point(f, {0, 2, 1}, Face::top).uv, {0.5f, 1}));
  EXPECT_TRUE(near(surface_point(f, {0, -2, 2}, Face::bottom).uv, {0.5f, 0}));
}

TEST(SolidArea, MatchesClosedForms) {
  EXPECT_NEAR(area(Sphere{2}), 16 * kPi, 1e-4);
  EXPECT_NEAR(area(Frustum{1, 1, 3}), 8 * kPi, 1e-4);
  EXPECT_NEAR(area(Frustum{3, 0, 4}), 24 * kPi, 1e-4);  // slant 5
  // A unit sphere stretched to (2, 1, 1).
  EXPECT_NEAR(area(Solid(Sphere{1}), Affine{{2, 0, 0}, {0, 1, 0}, {0, 0, 1}, {7, 7, 7}}), 21.478, 0.005);
  // A cylinder stretched along its axis, and mirrored.
  EXPECT_NEAR(area(Solid(Frustum{1, 1, 2}), Affine{{1, 0, 0}, {0, -3, 0}, {0, 0, 1}, {0, 0, 0}}),
              2 * kPi + 12 * kPi, 0.03);
}

/// A number of cells of the surface and the cell of a point: the faces apart, the side by angle and height.
int cell_of(const Solid& solid, const SurfaceSample& s) {
  const Vec2f uv = surface_point(solid, s.p, s.face).uv;
  const auto eighth = [](float x) { return std::min(7, int(x * 8)); };
  return int(s.face) * 64 + eighth(uv.y) * 8 + eighth(uv.x);
}

// The area of each cell by a fine grid over uv, against the share of the samples that fall into it.
TEST(SolidArea, SamplesAreUniform) {
  for (const Solid& solid : kSolids) {
    constexpr int kSamples = 100000, kFine = 64;
    std::vector<double> observed(192, 0), expected(192, 0);
    for (int i = 0; i < kSamples; ++i) {
      const Vec2f u(to_unit_float(hash32(i, 5)), to_unit_float(hash32(i, 6)));
      ++observed[cell_of(solid, sample_surface(solid, u))];
    }
    // Each face from its own parametrisation, in double.
    const auto add = [&](const Vec3d& p, Face face, double area_of_it) {
      expected[cell_of(solid, {Vec3f(p), face})] += area_of_it;
    };
    for (int j = 0; j < 8 * kFine; ++j)
      for (int i = 0; i < 8 * kFine; ++i) {
        const double a = (i + 0.5) / (8 * kFine), b = (j + 0.5) / (8 * kFine);
        const double phi = 2 * std::numbers::pi * a, da = 1.0 / (8 * kFine), db = da;
        if (const auto* sphere = std::get_if<Sphere>(&solid)) {
          const double theta = std::numbers::pi * b, r = sphere->radius;
          add(Vec3d(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi)) * r,
              Face::side, r * r * std::sin(theta) * 2 * std::numbers::pi * std::numbers::pi * da * db);
          continue;
        }
        const auto& f = std::get<Frustum>(solid);
        const double r = f.radius_top + (double(f.radius_bottom) - f.radius_top) * b;
        const double slant = std::hypot(double(f.height), double(f.radius_bottom) - f.radius_top);
        add({r * std::sin(phi), (0.5 - b) * f.height, r * std::cos(phi)}, Face::side,
            r * 2 * std::numbers::pi * slant * da * db);
        for (const Face cap : {Face::top, Face::bottom}) {
          const double radius = cap == Face::top ? f.radius_top : f.radius_bottom, rho = radius * b;
          add({rho * std::sin(phi), cap == Face::top ? 0.5 * f.height : -0.5 * f.height, rho * std::cos(phi)},
              cap, rho * radius * 2 * std::numbers::pi * da * db);
        }
      }
    double total = 0;
    for (const double e : expected) total += e;
    EXPECT_NEAR(total / area(solid), 1, 1e-4);
    for (double& e : expected) e *= kSamples / total;
    EXPECT_TRUE(chi_square(observed, expected, int(kSolids.size())));
  }
}

// Bounds hold every point of the surface and are touched on each side.
TEST(SolidBounds, AreTightUnderAnyMap) {
  for (const Solid& solid : kSolids)
    for (const Affine& map : {Affine{}, stretched()}) {
      const Box3f box = bounds(solid, map);
      Box3f seen;
      for (int i = 0; i < 200000; ++i) {
        const Vec2f u(to_unit_float(hash32(i, 7)), to_unit_float(hash32(i, 8)));
        seen.extendBy(map.point(sample_surface(solid, u).p));
      }
      const Vec3f slack = box.size() * 1e-6f + Vec3f(1e-6f);
      for (int k = 0; k < 3; ++k) {
        EXPECT_LE(box.min[k], seen.min[k] + slack[k]);
        EXPECT_GE(box.max[k], seen.max[k] - slack[k]);
        EXPECT_NEAR(box.min[k], seen.min[k], 0.03f * box.size()[k]);
        EXPECT_NEAR(box.max[k], seen.max[k], 0.03f * box.size()[k]);
      }
    }
}

}  // namespace
}  // namespace parian
