// The ray queries against a brute-force loop in double precision, and what rests on them: alpha, disks,
// edits.
#include "renderer/accel/accel.h"

#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// A scene with what is built from it.
struct Built {
  explicit Built(Scene s, bool editable = false) : scene(std::move(s)), world(make_world(scene)) {
    accel = std::make_unique<Accel>(scene, world, AccelSettings{editable});
  }
  Scene scene;
  World world;
  std::unique_ptr<Accel> accel;
};

Primitive random_triangles(TestRandom& random, int count, float size) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (int i = 0; i < count; ++i) {
    const Vec3f center = Vec3f(random.next1(), random.next1(), random.next1()) * 2 - Vec3f(1);
    const auto first = std::uint32_t(positions.size());
    for (int k = 0; k < 3; ++k) positions.push_back(center + random.direction() * size);
    triangles.push_back({first, first + 1, first + 2});
  }
  Primitive p;
  p.positions = std::move(positions);
  p.triangles = std::move(triangles);
  return p;
}

Transform matrix(const Imath::M44f& m) {
  Transform t;
  t.matrix = m;
  return t;
}

/// Meshes placed once and often: turned, stretched, mirrored, sheared, nested.
Scene many_placements(std::uint32_t seed) {
  TestRandom random(seed);
  Scene scene;
  const int material = add_material(scene, make_lambert({1, 1, 1}));
  for (const int primitives : {1, 2, 3}) {
    Mesh mesh;
    for (int i = 0; i < primitives; ++i) {
      mesh.primitives.push_back(random_triangles(random, 60, 0.4f));
      mesh.primitives.back().material = material;
    }
    scene.meshes.push_back(mesh);
  }
  const auto place = [&](int mesh, const Transform& transform) {
    Node node;
    node.mesh = mesh;
    node.transform = transform;
    return add_root(scene, node);
  };
  place(0, {});                                                                        // identity, flattened
  place(1, matrix({1, 0.5f, 0, 0, -0.2f, 1, 0.3f, 0, 0, 0.6f, 0.9f, 0, 2, 0, 0, 1}));  // shear
  const int parent = place(1, matrix({-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0.5f, 0, 1}));  // mirror
  place(1, matrix({0, 2, 0, 0, -0.5f, 0, 0, 0, 0, 0, 1.5f, 0, 0, 2, 1, 1}));  // turn, stretch
  place(2, matrix({0.6f, 0.8f, 0, 0, -0.8f, 0.6f, 0, 0, 0, 0, -0.7f, 0, 0.3f, -2, 0.4f,
                   1}));  // flattened, mirrored
  Node child;
  child.mesh = 1;
  child.transform = translate({-0.5f, 1, 0.5f});
  child.transform.scale = {0.5f, 1, 2};
  scene.nodes[std::size_t(parent)].children.push_back(int(scene.nodes.size()));
  scene.nodes.push_back(child);
  return scene;
}

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

Ray random_ray(TestRandom& random, const Vec3f& low, const Vec3f& high) {
  const auto point = [&] {
    return Vec3f(low.x + random.next1() * (high.x - low.x), low.y + random.next1() * (high.y - low.y),
                 low.z + random.next1() * (high.z - low.z));
  };
  const Vec3f origin = point();
  return {origin, normalize(point() - origin)};
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

/// Asks about rays one by one, and again in packets of a given size, and counts where the answers differ.
class Packets {
 public:
  explicit Packets(const Accel& accel, int size = RayPacket::kSize) : accel_(accel), size_(size) {}

  void add(const Ray& ray, std::uint32_t random = 0) {
    accel_.intersect(ray, random, alone_[rays_.count]);
    rays_.add(ray, random);
    if (rays_.count == size_) ask();
  }

  int rays = 0;
  int lost = 0, invented = 0;  // hits that the packet, or the ray alone, does not have
  int other = 0;               // another triangle, or at another distance
  int shadows = 0;             // occluded() disagrees with intersect(), in packets
  int blocked_alone = 0;       // occluded() blocks what intersect() of the ray alone leaves open

 private:
  void ask() {
    std::array<Hit, RayPacket::kSize> hits;
    accel_.intersect(rays_, hits);
    const std::uint32_t blocked = accel_.occluded(rays_);
    EXPECT_EQ(blocked >> rays_.count, 0u);
    for (int i = 0; i < rays_.count; ++i, ++rays) {
      const bool found = hits[i].placement != Hit::kMiss, alone = alone_[i].placement != Hit::kMiss;
      lost += alone && !found;
      invented += found && !alone;
      shadows += found != bool(blocked >> i & 1);
      blocked_alone += !alone && (blocked >> i & 1);
      if (found && alone)
        other += std::abs(hits[i].t - alone_[i].t) > 1e-5f * alone_[i].t ||
                 hits[i].placement != alone_[i].placement || hits[i].primitive != alone_[i].primitive ||
                 hits[i].triangle != alone_[i].triangle;
    }
    rays_.count = 0;
  }

  const Accel& accel_;
  int size_;
  RayPacket rays_;
  std::array<Hit, RayPacket::kSize> alone_;
};

// Caught: lanes that are exchanged, tmax of the first ray for all, a lane beyond the count that is traced, an
// instance taken from the first lane.
TEST(Accel, PacketsGiveTheHitsOfSingleRays) {
  for (const bool editable : {false, true})
    for (const int size : {1, 5, 16}) {
      const Built b(many_placements(5), editable);
      TestRandom random(6);
      Packets apart(*b.accel, size), along(*b.accel, size);
      for (int i = 0; i < 16000; ++i) {
        Ray ray = random_ray(random, {-4, -4, -3}, {4, 4, 3});
        if (i % 3 == 0) ray.tmax = 4 * random.next1();
        apart.add(ray);
      }
      for (int i = 0; i < 1000; ++i) {
        const Ray ray = random_ray(random, {-4, -4, -3}, {4, 4, 3});
        for (int k = 0; k < 16; ++k) along.add({ray.o, normalize(ray.d + random.direction() * 0.02f)});
      }
      for (const Packets* p : {&apart, &along}) {
        EXPECT_GT(p->rays, 15000);
        // At an edge the two may round apart.
        EXPECT_LE(p->lost + p->invented + p->other + p->shadows, 2) << p->lost << p->invented << p->other;
      }
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

// GT 52. Caught: RTC_SCENE_FLAG_ROBUST left out, by which about one ray in a thousand at an edge gets out.
TEST(Accel, NothingLeaksThroughSharedEdges) {
  Transform turned = translate({10, -20, 5});
  turned.rotation = Quatf(0.5f, 0.5f, 0.1f, 0.7f).normalized();
  turned.scale = {1, 3, 0.2f};
  for (const bool editable : {false, true})
    for (const Aim aim : {Aim::edge, Aim::near_vertex})
      for (const Transform& transform : {Transform{}, turned})
        EXPECT_EQ(count_leaks(150000, aim, editable, transform, 11), 0);
}

// GT 52: the limit of Embree's robust mode. A ray aimed at the very coordinates of a vertex, where the edge
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

// GT 43 to 46. Caught: a constant offset of 1e-4, error_gamma(1) for error_gamma(16), the condition of the
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

/// A pane in the plane z = -depth that covers `alpha`.
void add_pane(Scene& scene, float depth, float alpha, AlphaMode mode = AlphaMode::blend) {
  Material m = make_lambert({1, 1, 1});
  m.alpha_mode = mode;
  m.alpha = alpha;
  add_mesh(scene, make_quad({0, 0, -depth}, {1, 0, 0}, {0, 1, 0}), add_material(scene, m));
}

// Caught: coverage compared the wrong way round, both panes decided by the same number (.1 instead of .28
// passes).
TEST(Accel, BlendedPanesCoverTheShareOfRaysThatAlphaSays) {
  for (const bool editable : {false, true}) {
    Scene scene;
    add_pane(scene, 1, 0.3f);
    add_pane(scene, 2, 0.6f);
    const Built b(std::move(scene), editable);
    TestRandom random(31);
    Statistics first, second, none, blocked;
    Packets packets(*b.accel);
    for (std::uint32_t i = 0; i < 200000; ++i) {
      const Ray ray{{random.next1() - 0.5f, random.next1() - 0.5f, 0}, {0, 0, -1}};
      Hit hit;
      const bool found = b.accel->intersect(ray, hash32(i), hit);
      first.add(found && hit.placement == 0);
      second.add(found && hit.placement == 1);
      none.add(!found);
      blocked.add(b.accel->occluded(ray, hash32(i)));
      ASSERT_EQ(b.accel->occluded(ray, hash32(i)), found);  // the same number, the same panes
      packets.add(ray, hash32(i));
    }
    EXPECT_EQ(packets.lost + packets.invented + packets.other + packets.shadows, 0);
    EXPECT_TRUE(mean_is(first, 0.3, 0.02));
    EXPECT_TRUE(mean_is(second, 0.7 * 0.6, 0.02));
    EXPECT_TRUE(mean_is(none, 0.7 * 0.4, 0.02));
    EXPECT_TRUE(mean_is(blocked, 1 - 0.7 * 0.4, 0.02));
  }
}

// Instances of one mesh decide apart: .5 x .5 passes both.
TEST(Accel, InstancesOfABlendedMeshDecideApart) {
  Scene scene;
  add_pane(scene, 1, 0.5f);
  Node second = scene.nodes[0];
  second.transform = translate({0, 0, -1});
  add_root(scene, second);
  const Built b(std::move(scene));
  Statistics blocked;
  for (std::uint32_t i = 0; i < 200000; ++i)
    blocked.add(b.accel->occluded({{0.1f, 0.2f, 0}, {0, 0, -1}}, hash32(i)));
  EXPECT_TRUE(mean_is(blocked, 0.75, 0.02));
}

// Caught: MASK treated as BLEND, the cutoff compared with > where alpha equals it, alpha of the texture
// ignored.
TEST(Accel, MaskCutsAtTheCutoff) {
  Scene scene;
  add_pane(scene, 1, 1, AlphaMode::mask);
  scene.materials[0].alpha_cutoff = 0.5f;
  // Alpha 0.2, 0.4, 0.6, 0.8 in four columns.
  std::vector<std::uint8_t> texels;
  for (const int alpha : {51, 102, 153, 204})
    texels.insert(texels.end(), {255, 255, 255, std::uint8_t(alpha)});
  Texture nearest;
  nearest.filter = Filter::nearest;
  scene.materials[0].base_color_texture =
      add_texture(scene, make_image(4, 1, 4, PixelType::u8, texels), nearest);
  for (const float factor : {1.0f, 0.7f}) {
    scene.materials[0].alpha = factor;
    const Built b(scene);
    TestRandom random(32);
    for (std::uint32_t i = 0; i < 20000; ++i) {
      const float x = 2 * random.next1() - 1;
      const Ray ray{{x, 2 * random.next1() - 1, 0}, {0, 0, -1}};
      Hit hit;
      const bool expected = x >= (factor == 1 ? 0.0f : 0.5f);
      if (std::abs(x) < 1e-4f || std::abs(x - 0.5f) < 1e-4f) continue;
      ASSERT_EQ(b.accel->intersect(ray, hash32(i), hit), expected) << x;
      ASSERT_EQ(b.accel->occluded(ray, hash32(i)), expected) << x;
    }
  }
  scene.materials[0].base_color_texture = {};
  scene.materials[0].alpha = scene.materials[0].alpha_cutoff;
  const Built equal(scene);
  EXPECT_TRUE(equal.accel->occluded({{0, 0, 0}, {0, 0, -1}}, 1));
}

TEST(Accel, VertexAlphaCovers) {
  Scene scene;
  add_pane(scene, 1, 0.5f);
  scene.meshes[0].primitives[0].colors = std::vector<Vec4f>(4, Vec4f(1, 1, 1, 0.5f));
  const Built b(std::move(scene));
  Statistics blocked;
  for (std::uint32_t i = 0; i < 200000; ++i)
    blocked.add(b.accel->occluded({{0.1f, 0.2f, 0}, {0, 0, -1}}, hash32(i)));
  EXPECT_TRUE(mean_is(blocked, 0.25, 0.03));
}

Light area_light(LightKind kind, float width, float height) {
  Light light;
  light.kind = kind;
  light.width = width;
  light.height = height;
  return light;
}

// Caught: the disk filter set for intersect alone, a disk of radius `width`, every light of a mixed set cut.
TEST(Accel, DiskLightsAreRoundAndRectanglesAreNot) {
  Scene scene;
  add_light(scene, area_light(LightKind::disk, 2, 1), translate({0, 0, -1}));
  add_light(scene, area_light(LightKind::rectangle, 2, 1), translate({5, 0, -1}));
  const Built b(std::move(scene));
  TestRandom random(41);
  Statistics disk, rectangle;
  Packets packets(*b.accel);
  for (int i = 0; i < 100000; ++i) {
    const float x = 2 * random.next1() - 1, y = 2 * random.next1() - 1;
    const Ray ray{{x, y, 0}, {0, 0, -1}}, beside{{x + 5, y, 0}, {0, 0, -1}};
    const bool round = x * x + y * y <= 1;
    if (std::abs(x * x + y * y - 1) < 1e-4f) continue;
    Hit hit;
    const bool found = b.accel->intersect(ray, 0, hit);
    ASSERT_EQ(found, round) << x << " " << y;
    ASSERT_EQ(b.accel->occluded(ray, 0), round);
    if (found) {
      ASSERT_EQ(hit.placement, Hit::kAreaLightHit);
      ASSERT_EQ(hit.triangle, 0u);
    }
    disk.add(found);
    packets.add(ray);
    packets.add(beside);
    const bool flat = b.accel->intersect(beside, 0, hit);
    if (std::abs(std::abs(y) - 0.5f) > 1e-4f) {
      ASSERT_EQ(flat, std::abs(y) < 0.5f);
    }
    if (flat) {
      ASSERT_EQ(hit.triangle, 1u);
    }
    rectangle.add(flat);
  }
  EXPECT_EQ(packets.lost + packets.invented + packets.other + packets.shadows, 0);
  EXPECT_TRUE(mean_is(disk, std::numbers::pi / 4, 0.02));
  EXPECT_TRUE(mean_is(rectangle, 0.5, 0.02));
}

/// Two meshes, one drawn twice, a pane and two area lights.
Scene editable_scene() {
  Scene scene = many_placements(9);
  add_light(scene, area_light(LightKind::disk, 2, 1), translate({0, 3, 0}));
  add_light(scene, area_light(LightKind::rectangle, 1, 1), translate({0, -3, 0}));
  return scene;
}

void expect_same_hits(const Built& a, const Built& b) {
  TestRandom random(51);
  int hits = 0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray = random_ray(random, {-5, -5, -5}, {5, 5, 5});
    Hit one{}, two{};
    const bool found = a.accel->intersect(ray, 0, one);
    ASSERT_EQ(found, b.accel->intersect(ray, 0, two));
    ASSERT_EQ(a.accel->occluded(ray, 0), found);
    if (!found) continue;
    ++hits;
    ASSERT_EQ(one.placement, two.placement);
    ASSERT_EQ(one.primitive, two.primitive);
    ASSERT_EQ(one.triangle, two.triangle);
    ASSERT_NEAR(one.t, two.t, 1e-5f * (1 + two.t));
  }
  EXPECT_GT(hits, 1000);
}

// Caught: an edit that leaves flattened vertices, or the area lights, where they were; a mesh built anew for
// a move.
TEST(Accel, UpdateMovesPlacementsAndAreaLights) {
  for (const bool editable : {false, true}) {
    Built b(editable_scene(), editable);
    const BuildCounts before = b.accel->builds();
    // Each mesh once: as a BVH, or as a copy in world space of each of its primitives.
    EXPECT_EQ(before.meshes, 1 + 2 + 3);
    EXPECT_EQ(before.top_level, 1);

    Scene moved = b.scene;
    moved.nodes[0].transform = translate({1, 1, 1});   // flattened unless editable; was the identity
    moved.nodes[1].transform = translate({0, -1, 2});  // an instance in either case
    moved.nodes[moved.nodes.size() - 2].transform = translate({2, 2, 2});  // the disk
    const World world = make_world(moved, &b.world);
    b.accel->update_transforms(moved, world);
    const BuildCounts after = b.accel->builds();
    EXPECT_EQ(after.meshes, before.meshes + (editable ? 0 : 1));
    EXPECT_EQ(after.top_level, 2);
    const Built fresh(moved, editable);
    expect_same_hits(b, fresh);
    // And back.
    b.accel->update_transforms(b.scene, b.world);
    const Built original(b.scene, editable);
    expect_same_hits(b, original);
  }
}

TEST(Accel, RebindFollowsMaterials) {
  Scene scene;
  add_pane(scene, 1, 0.3f);
  Built b(scene);
  Scene edited = scene;
  edited.materials[0].alpha = 0.8f;
  const World world = make_world(edited, &b.world);
  b.accel->rebind(edited, world);
  b.scene.materials[0].alpha = 0;  // what was given first no longer counts
  Statistics blocked;
  for (std::uint32_t i = 0; i < 50000; ++i)
    blocked.add(b.accel->occluded({{0, 0.3f, 0}, {0, 0, -1}}, hash32(i)));
  EXPECT_TRUE(mean_is(blocked, 0.8, 0.02));
  EXPECT_EQ(b.accel->builds().top_level, 1);
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
