// What rounding must not do: leaks at edges, hits of the triangle that a ray left, hits of triangles of no
// area.
#include <gtest/gtest.h>

#include <cmath>

#include "renderer/scene/surface.h"
#include "tests/renderer/accel/support/built.h"
#include "tests/renderer/accel/support/packets.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// A closed sphere that shares its vertices, poles included.
Primitive closed_sphere(int rings, int sectors) {
  std::vector<Vec3f> positions{{0, 1, 0}, {0, -1, 0}};
  for (int j = 1; j < rings; ++j)
    for (int i = 0; i < sectors; ++i) {
      const float theta = kPi * float(j) / float(rings), phi = 2 * kPi * float(i) / float(sectors);
      positions.emplace_back(std::sin(theta) * std::cos(phi), std::cos(theta),
                             std::sin(theta) * std::sin(phi));
    }
  const auto at = [&](int j, int i) {
    return j == 0 ? 0u : j == rings ? 1u : std::uint32_t(2 + (j - 1) * sectors + i % sectors);
  };
  std::vector<Triangle> triangles;
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < sectors; ++i) {
      if (j > 0) triangles.push_back({at(j, i), at(j, i + 1), at(j + 1, i)});
      if (j + 1 < rings) triangles.push_back({at(j, i + 1), at(j + 1, i + 1), at(j + 1, i)});
    }
  Primitive p;
  p.positions = std::move(positions);
  p.triangles = std::move(triangles);
  return p;
}

enum class Aim { vertex, edge, near_vertex };

/// Rays from inside a closed sphere at its vertices or edges that get out, alone or in a packet.
int count_leaks(int rays, Aim aim, bool editable, const Transform& transform, std::uint32_t seed) {
  Scene scene;
  add_mesh(scene, closed_sphere(20, 30), add_material(scene, make_lambert({1, 1, 1})), transform);
  const Built b(std::move(scene), editable);
  const Primitive& p = b.scene.meshes[0].primitives[0];
  const Affine& m = b.world.placements[0].to_world;
  TestRandom random(seed);
  int leaks = 0;
  Packets packets(*b.accel);
  for (int i = 0; i < rays; ++i) {
    const Triangle& t = p.triangles[std::size_t(random.next1() * float(p.triangles.size()))];
    Vec3f target = m.point(p.positions[t[0]]);
    if (aim == Aim::edge) target += (m.point(p.positions[t[1]]) - target) * (0.01f + 0.98f * random.next1());
    if (aim == Aim::near_vertex) target += random.direction() * 1e-4f;
    const Vec3f origin = m.point(random.direction() * (0.9f * random.next1()));
    const Ray ray{origin, normalize(target - origin)};
    Hit hit;
    if (!b.accel->intersect(ray, 0, hit)) ++leaks;
    packets.add(ray);
  }
  return leaks + packets.lost + packets.shadows;
}

// Caught: RTC_SCENE_FLAG_ROBUST left out, by which about one ray in a thousand at an edge gets out.
TEST(Accel, NothingLeaksThroughSharedEdges) {
  Transform turned = translate({10, -20, 5});
  turned.rotation = Quatf(0.5f, 0.5f, 0.1f, 0.7f).normalized();
  turned.scale = {1, 3, 0.2f};
  for (const bool editable : {false, true})
    for (const Aim aim : {Aim::edge, Aim::near_vertex})
      for (const Transform& transform : {Transform{}, turned})
        EXPECT_EQ(count_leaks(150000, aim, editable, transform, 11), 0);
}

// The limit of Embree's robust mode. A ray aimed at the very coordinates of a vertex, where the edge
// tests of all its triangles round apart, gets out once in some 2000 on a sphere around the origin and once
// in some 100 on one that lies 20 radii away; nothing but such an aim finds a vertex.
TEST(Accel, RaysAtExactVerticesRarelyLeak) {
  EXPECT_LT(count_leaks(100000, Aim::vertex, false, {}, 12), 100);
  EXPECT_LT(count_leaks(100000, Aim::vertex, true, {}, 13), 100);
  EXPECT_LT(count_leaks(100000, Aim::vertex, false, translate({10, -20, 5}), 14), 2000);
}

Quatf random_rotation(TestRandom& random) {
  const Vec3f axis = random.direction();
  Quatf q;
  q.setAxisAngle(axis, 2 * kPi * random.next1());
  return q.normalized();
}

/// Places a few triangles by random rotations, scales of each axis, translations and sizes, and lets rays
/// leave them to both sides: how many meet the triangle that they left.
struct SelfHits {
  int rays = 0, hits = 0;
  int blocked = 0;  // in a packet of shadow rays, where alone they meet nothing
};
SelfHits count_self_hits(int scenes, int rays, bool editable, std::uint32_t seed) {
  TestRandom random(seed);
  SelfHits result;
  for (int n = 0; n < scenes; ++n) {
    Scene scene;
    const auto power = [&](float range) { return std::pow(10.0f, range * (2 * random.next1() - 1)); };
    // Half of the size is in the vertices, half in the node.
    const float size = power(3), node_size = power(3);
    Primitive p = random_triangles(random, 16, 0.5f);
    std::vector<Vec3f> positions(p.positions.begin(), p.positions.end());
    const Vec3f shift = n % 3 == 0 ? random.direction() * power(4) : Vec3f(0);
    for (Vec3f& v : positions) v = v * size + shift;
    p.positions = std::move(positions);
    Transform shear;  // rotation after scale after rotation, by two nodes
    shear.rotation = random_rotation(random);
    add_mesh(scene, p, add_material(scene, make_lambert({1, 1, 1})), shear);
    Node parent;
    parent.transform.rotation = random_rotation(random);
    parent.transform.scale = Vec3f(power(1), power(1), n % 2 ? power(1) : -power(1)) * node_size;
    parent.transform.translation = n % 4 == 0 ? Vec3f(0) : random.direction() * (1e4f * random.next1());
    parent.children = {0};
    scene.roots.clear();
    add_root(scene, parent);
    const Built b(std::move(scene), editable);
    Packets packets(*b.accel);
    const Placement& placement = b.world.placements.at(0);
    const Primitive& placed = b.scene.meshes[0].primitives[0];
    const Box3f& box = b.world.bounds;
    for (int i = 0; i < rays; ++i) {
      const Triangle& t = placed.triangles[std::size_t(random.next1() * float(placed.triangles.size()))];
      const Vec2f u = random.next2();
      const float s = std::sqrt(u.x);
      const Vec3f target =
          placement.to_world.point(placed.positions[t[0]] * (1 - s) + placed.positions[t[1]] * (s * u.y) +
                                   placed.positions[t[2]] * (s * (1 - u.y)));
      const Vec3f origin = target + random.direction() * ((0.01f + random.next1()) * box.size().length());
      Hit hit;
      if (origin == target || !b.accel->intersect({origin, normalize(target - origin)}, 0, hit)) continue;
      const Surface surface = make_surface(b.scene, b.world, hit, normalize(target - origin));
      if (!is_finite(surface.ng)) continue;  // a sliver of no area in single precision
      const Vec3f w = random.direction();
      Hit again;
      ++result.rays;
      const Ray leaving{ray_origin(surface, w), w};
      if (b.accel->intersect(leaving, 0, again) && again.triangle == hit.triangle) ++result.hits;
      packets.add(leaving);
    }
    result.blocked += packets.blocked_alone;
  }
  return result;
}

// Caught: a constant offset of 1e-4, error_gamma(1) for error_gamma(16), the condition of the
// placement left out, p itself as the origin.
TEST(Accel, RaysDoNotMeetTheTriangleTheyLeft) {
  for (const bool editable : {false, true}) {
    const SelfHits result = count_self_hits(300, 600, editable, editable ? 21 : 22);
    EXPECT_GT(result.rays, 100000);
    EXPECT_EQ(result.hits, 0) << "of " << result.rays << (editable ? ", instanced" : ", flattened");
    EXPECT_LE(result.blocked, 1);  // at the edge of another triangle the two may round apart
  }
}

TEST(NightlyAccel, RaysDoNotMeetTheTriangleTheyLeft) {
  for (const bool editable : {false, true}) {
    const SelfHits result = count_self_hits(5000, 1500, editable, editable ? 23 : 24);
    EXPECT_GT(result.rays, 5000000);
    EXPECT_EQ(result.hits, 0) << "of " << result.rays << (editable ? ", instanced" : ", flattened");
    EXPECT_LE(result.blocked, 20);
  }
}

TEST(Accel, DegenerateTrianglesAreHarmless) {
  for (const bool editable : {false, true}) {
    Scene scene;
    const int material = add_material(scene, make_lambert({1, 1, 1}));
    Primitive p;
    p.positions = std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {-1, -1, -1}, {1, -1, -1}, {0, 1, -1}};
    p.triangles = std::vector<Triangle>{{0, 0, 0}, {0, 1, 2}, {0, 1, 1}, {3, 4, 5}};
    add_mesh(scene, p, material);
    const Built b(std::move(scene), editable);
    TestRandom random(61);
    for (int i = 0; i < 10000; ++i) {
      const Vec3f target(random.next1() * 2 - 1, random.next1() - 0.5f, 0);
      const Ray ray{{0, 0, 5}, normalize(target - Vec3f(0, 0, 5))};
      Hit hit;
      if (b.accel->intersect(ray, 0, hit)) {
        ASSERT_EQ(hit.triangle, 3u);
      }
    }
    // Straight at the line that the second triangle is.
    Hit hit;
    if (b.accel->intersect({{0.5f, 0, 5}, {0, 0, -1}}, 0, hit)) {
      EXPECT_EQ(hit.triangle, 3u);
    }
  }
}

}  // namespace
}  // namespace parian
