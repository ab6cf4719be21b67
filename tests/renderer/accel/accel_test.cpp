// The ray queries of single rays against a brute-force loop in double precision; what a build holds.
#include "renderer/accel/accel.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/renderer/accel/support/built.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

struct Truth {
  double t = 1e300, u = 0, v = 0;
  std::uint32_t placement = 0, primitive = 0, triangle = 0;
  bool doubtful = false;  // near an edge, or with another hit close by
};

Vec3d to_double(const Affine& m, const Vec3f& p) {
  return Vec3d(m.x) * double(p.x) + Vec3d(m.y) * double(p.y) + Vec3d(m.z) * double(p.z) + Vec3d(m.origin);
}

/// Every triangle of every placement, by Moeller and Trumbore in double.
std::optional<Truth> brute_force(const Built& b, const Ray& ray) {
  constexpr double kEdge = 2e-5;
  Truth best;
  const Vec3d o(ray.o), d(ray.d);
  bool found = false, near_edge = false;
  for (std::uint32_t i = 0; i < b.world.placements.size(); ++i) {
    const Placement& placement = b.world.placements[i];
    const auto& primitives = b.scene.meshes[std::size_t(placement.mesh)].primitives;
    for (std::uint32_t k = 0; k < primitives.size(); ++k)
      for (std::uint32_t n = 0; n < primitives[k].triangles.size(); ++n) {
        const Triangle& t = primitives[k].triangles[n];
        const Vec3d a = to_double(placement.to_world, primitives[k].positions[t[0]]);
        const Vec3d e1 = to_double(placement.to_world, primitives[k].positions[t[1]]) - a;
        const Vec3d e2 = to_double(placement.to_world, primitives[k].positions[t[2]]) - a;
        const Vec3d p = d.cross(e2);
        const double det = e1.dot(p);
        const Vec3d s = o - a, q = s.cross(e1);
        const double u = s.dot(p) / det, v = d.dot(q) / det, distance = e2.dot(q) / det;
        if (!(distance > 1e-5 && distance < ray.tmax)) continue;
        const double inside = std::min({u, v, 1 - u - v});
        if (std::abs(inside) < kEdge || std::abs(det) < 1e-4 * e1.length() * e2.length())
          near_edge |= inside > -0.01;
        if (inside < 0) continue;
        if (found && std::abs(distance - best.t) < 1e-4) best.doubtful = true;
        if (distance >= best.t) continue;
        best = {distance, u, v, i, k, n, found && std::abs(distance - best.t) < 1e-4};
        found = true;
      }
  }
  best.doubtful |= near_edge;
  if (!found && !near_edge) return std::nullopt;
  return best;
}

// Caught: u and v exchanged, primitive 0 taken for every hit in an instance, an instance's transform
// transposed.
TEST(Accel, FindsTheNearestHitOfABruteForceLoop) {
  for (const bool editable : {false, true}) {
    const Built b(many_placements(3), editable);
    TestRandom random(4);
    int hits = 0, doubtful = 0;
    std::vector<int> by_placement(b.world.placements.size(), 0);
    for (int i = 0; i < 4000; ++i) {
      Ray ray = random_ray(random, {-4, -4, -3}, {4, 4, 3});
      if (i % 4 == 0) ray.tmax = 2;
      Hit hit;
      const bool found = b.accel->intersect(ray, 0, hit);
      const std::optional<Truth> truth = brute_force(b, ray);
      if (truth && truth->doubtful) {
        ++doubtful;
        continue;
      }
      ASSERT_EQ(found, truth.has_value()) << "ray " << i;
      if (!found) continue;
      ++hits;
      ++by_placement[hit.placement];
      ASSERT_EQ(hit.placement, truth->placement) << i;
      ASSERT_EQ(hit.primitive, truth->primitive) << i;
      ASSERT_EQ(hit.triangle, truth->triangle) << i;
      ASSERT_NEAR(hit.t, truth->t, 2e-5 * (1 + truth->t)) << i;
      ASSERT_NEAR(hit.u, truth->u, 2e-3) << i;
      ASSERT_NEAR(hit.v, truth->v, 2e-3) << i;
    }
    EXPECT_GT(hits, 1500);
    EXPECT_LT(doubtful, 200);
    for (const int count : by_placement) EXPECT_GT(count, 50);
  }
}

// Caught: a shadow ray that ignores tmax, or whose tmax is taken as a distance where the direction is not
// unit.
TEST(Accel, OccludedAgreesWithIntersect) {
  const Built b(many_placements(7));
  TestRandom random(8);
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = random_ray(random, {-4, -4, -3}, {4, 4, 3});
    Hit hit;
    const bool found = b.accel->intersect(ray, 0, hit);
    ASSERT_EQ(b.accel->occluded(ray, 0), found) << i;
    if (!found) continue;
    const float length = 0.1f + 5 * random.next1();
    const auto until = [&](float t) { return Ray{ray.o, ray.d * length, t / length}; };
    ASSERT_FALSE(b.accel->occluded(until(hit.t * 0.999f), 0)) << i;
    ASSERT_TRUE(b.accel->occluded(until(hit.t * 1.001f), 0)) << i;
  }
}

TEST(Accel, AnEmptySceneAndEmptyMeshesAreHitByNothing) {
  Hit hit;
  const Ray ray{{0, 0, 5}, {0, 0, -1}};
  const Built empty(Scene{});
  EXPECT_FALSE(empty.accel->intersect(ray, 0, hit));
  EXPECT_FALSE(empty.accel->occluded(ray, 0));
  EXPECT_TRUE(empty.world.bounds.isEmpty());

  for (const bool editable : {false, true}) {
    Scene scene;
    const int material = add_material(scene, make_lambert({1, 1, 1}));
    add_mesh(scene, Primitive{}, material);
    scene.meshes.push_back({"no primitives", {}});
    Node node;
    node.mesh = 1;
    add_root(scene, node);
    add_mesh(scene, make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), material);
    scene.nodes.back().transform.scale = {1, 0, 1};  // hidden
    const Built b(std::move(scene), editable);
    EXPECT_FALSE(b.accel->intersect(ray, 0, hit));
    EXPECT_FALSE(b.accel->occluded(ray, 0));
  }
}

TEST(Accel, BoundsHoldPlacementsAndAreaLights) {
  Scene scene;
  add_mesh(scene, make_box({0, 0, 0}, {1, 1, 1}), add_material(scene, make_lambert({1, 1, 1})),
           translate({1, 2, 3}));
  add_light(scene, area_light(LightKind::rectangle, 2, 4), translate({0, 0, -7}));
  const World world = make_world(scene);
  EXPECT_EQ(world.bounds.min, Vec3f(-1, -2, -7));
  EXPECT_EQ(world.bounds.max, Vec3f(2, 3, 4));
}

TEST(Accel, MemoryIsCounted) {
  TestRandom random(71);
  Scene scene;
  add_mesh(scene, random_triangles(random, 20000, 0.1f), add_material(scene, make_lambert({1, 1, 1})));
  const Built b(std::move(scene));
  EXPECT_GT(b.accel->bytes(), 20000u * 36);
  EXPECT_LT(b.accel->bytes(), 20000u * 1000);
}

}  // namespace
}  // namespace parian
