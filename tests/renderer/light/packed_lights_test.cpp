// More lights than have records, and than a tree's nodes are left half full for: the same laws, bounded
// memory, and the same bits for any number of threads.
#include <gtest/gtest.h>

#include "renderer/base/parallel.h"
#include "tests/renderer/light/support/lit_scene.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

const Vec3f kUp(0, 1, 0);

/// A flat one-sided light of some size at p.
LightBounds make_light_at(const Vec3f& p, const Vec3f& axis, float size) {
  LightBounds light;
  light.box = {p - Vec3f(size), p + Vec3f(size)};
  light.axis = axis;
  light.intensity = 1;
  return light;
}

std::vector<LightBounds> make_lights(std::size_t count, TestRandom& random) {
  std::vector<LightBounds> lights;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2f xy = random.next2();
    lights.push_back(make_light_at({10 * xy.x, 3 * random.next1(), 10 * xy.y}, random.direction(), 0.01f));
    lights.back().intensity = std::pow(10.0f, -6 * random.next1());
    lights.back().two_sided = i % 3 == 0;
  }
  return lights;
}

/// A mesh of emissive triangles of a side of .01 around `center`.
Primitive make_dust(std::size_t count, const Vec3f& center, TestRandom& random) {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 3 * count; i += 3) {
    const Vec3f p = center + random.direction() * random.next1();
    for (const Vec3f& corner : {p, p + random.direction() * 0.01f, p + random.direction() * 0.01f})
      positions.push_back(corner);
    triangles.push_back({i, i + 1, i + 2});
  }
  Primitive primitive;
  primitive.positions = std::move(positions);
  primitive.triangles = std::move(triangles);
  return primitive;
}

TEST(PackedLights, AreTheSameForAnyNumberOfThreads) {
  TestRandom random(1);
  const std::vector<LightBounds> lights = make_lights(30000, random);
  const int threads = thread_count();
  set_thread_count(1);
  const LightTree one{std::span(lights)};
  set_thread_count(4);
  const LightTree four{std::span(lights)};
  set_thread_count(threads);
  EXPECT_EQ(one.bytes(), four.bytes());
  const Receiver to{{3, -1, 4}, kUp};
  EXPECT_EQ(one.importance(to), four.importance(to));
  for (int i = 0; i < 30000; ++i) ASSERT_EQ(one.probability(to, i), four.probability(to, i)) << i;
}

TEST(PackedLights, ProbabilitiesAddUpAndAreThoseOfSamples) {
  TestRandom random(2);
  const std::vector<LightBounds> lights = make_lights(10000, random);
  const LightTree tree{std::span(lights)};
  for (int i = 0; i < 20; ++i) {
    const Receiver to{{10 * random.next1(), -0.5f, 10 * random.next1()}, i % 2 ? kUp : Vec3f(0)};
    double sum = 0;
    for (int light = 0; light < 10000; ++light) sum += tree.probability(to, light);
    EXPECT_NEAR(sum, 1, 1e-9);
    for (int k = 0; k < 1000; ++k) {
      const LightTree::Choice chosen = tree.sample(to, random.next1() + 0x1p-24 * double(random.next1()));
      ASSERT_EQ(chosen.probability, tree.probability(to, chosen.light));
    }
  }
}

// What is rounded in a node must not hide the edge of a light: flat ones in a plane, seen from beside it, and
// from far away.
TEST(PackedLights, NoneThatReachesTheReceiverIsLost) {
  TestRandom random(3);
  for (const float scale : {1e-3f, 1.0f, 1e4f}) {
    std::vector<LightBounds> lights;
    for (int i = 0; i < 5000; ++i)
      lights.push_back(make_light_at(random.direction() * (scale * random.next1()), random.direction(), 0));
    const LightTree tree{std::span(lights)};
    int reaching = 0;
    for (int i = 0; i < 40; ++i) {
      const Receiver to{random.direction() * (scale * std::pow(10.0f, 2 * random.next1() - 1)), Vec3f(0)};
      for (int k = 0; k < 5000; ++k) {
        const Vec3d way = Vec3d(to.p) - Vec3d(lights[k].box.min);
        if (Vec3d(lights[k].axis).dot(way) <= 1e-9 * way.length()) continue;
        ++reaching;
        ASSERT_GT(tree.probability(to, k), 0) << scale;
      }
    }
    EXPECT_GT(reaching, 50000);
  }
}

TEST(PackedLights, InOnePlaceAreChosenAlike) {
  const std::vector<LightBounds> lights(10000, make_light_at({0, 1, 0}, -kUp, 0.1f));
  const LightTree tree{std::span(lights)};
  EXPECT_LE(tree.depth(), 7);
  for (int i = 0; i < 10000; i += 11) EXPECT_NEAR(tree.probability({Vec3f(0), kUp}, i), 1e-4, 2e-6);
}

// --- Memory ---

TEST(PackedLights, MemoryIsAsPredicted) {
  TestRandom random(4);
  for (const std::size_t count : {5000, 20000, 100000}) {
    const std::vector<LightBounds> lights = make_lights(count, random);
    const auto bytes = double(LightTree(std::span(lights)).bytes());
    EXPECT_NEAR(bytes / double(LightTree::predicted_bytes(count)), 1, 0.1) << count;
    EXPECT_LT(bytes / double(count), 60);
    Scene scene;
    add_mesh(scene, make_dust(count, Vec3f(0), random), add_material(scene, make_emitter(Rgb(1))));
    for (const LightChoice choice : {LightChoice::tree, LightChoice::power}) {
      const World world = make_world(scene);
      const LightTable table(scene, world, choice);
      const LightTableBytes predicted = light_table_bytes(count, choice);
      EXPECT_NEAR(double(table.bytes()) / double(predicted.held), 1, 0.1) << count;
      EXPECT_LT(double(predicted.peak) / double(count), 160);
    }
  }
}

// A mesh of 100 triangles placed 100 times, and lit as by brute force: that each is where it is, of its own
// size.
TEST(PackedLights, InstancesAreLightsEach) {
  TestRandom random(5);
  Scene scene;
  const Primitive dust = make_dust(100, {0, 3, 0}, random);
  add_mesh(scene, dust, add_material(scene, make_emitter(Rgb(1))));
  std::vector<Transform> places;
  for (int i = 0; i < 100; ++i) {
    Transform place = translate({float(i % 10) - 4.5f, 0, float(i / 10) - 4.5f});
    place.scale = Vec3f(1 + 0.1f * float(i % 3));
    places.push_back(place);
  }
  scene.nodes[0].instances = instances(places);
  const LitScene lit(scene);
  ASSERT_EQ(lit.table.size(), 10000);
  EXPECT_NEAR(double(lit.table.bytes()) / double(light_table_bytes(10000, LightChoice::tree, 100).held), 1,
              0.1);
  double truth = 0;
  for (const Placement& placement : lit.world.placements)
    for (const Triangle& t : dust.triangles) {
      const Affine& m = placement.to_world;
      const Vec3d a(m.point(dust.positions[t[0]])), b(m.point(dust.positions[t[1]])),
          c(m.point(dust.positions[t[2]])), center = (a + b + c) / 3.0, normal = (b - a).cross(c - a) * 0.5;
      const double distance = center.length();
      truth += std::max(0.0, -normal.dot(center)) * center.y / std::pow(distance, 4);
    }
  EXPECT_TRUE(mean_is(irradiance(lit.table, {Vec3f(0), kUp}, kUp, 50000), truth, 0.02));
}

// Every second triangle has no area: it is no light, and takes no node.
TEST(PackedLights, TrianglesWithoutAreaAreNotChosen) {
  TestRandom random(6);
  Primitive dust = make_dust(10000, {0, 3, 0}, random);
  std::vector<Triangle> triangles(dust.triangles.begin(), dust.triangles.end());
  for (std::size_t i = 0; i < triangles.size(); i += 2) triangles[i][2] = triangles[i][1];
  dust.triangles = std::move(triangles);
  Scene scene;
  add_mesh(scene, dust, add_material(scene, make_emitter(Rgb(1))));
  const LitScene lit(scene);
  EXPECT_LT(double(lit.table.chooser().tree().bytes()), 0.6 * double(LightTree::predicted_bytes(10000)));
  for (std::uint32_t i = 0; i < 2000; ++i) {
    Sampler sampler(SamplerKind::independent, 1, 0, 0, i);
    const Vec2f u = sampler.next2();
    const auto chosen = lit.table.chooser().choose({Vec3f(0), kUp}, double(u.x));
    ASSERT_EQ(chosen.light % 2, 1);
  }
}

}  // namespace
}  // namespace parian
