// The table with more lights than are chosen by power: irradiance against sums over all lights, variance, and
// what the finite lights and those at infinity share.
#include <gtest/gtest.h>

#include "tests/renderer/light/support/lit_scene.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr double kPiD = std::numbers::pi;

/// Irradiance at `to` from a triangle of radiance 1 before it, all of it on the side of n (Lambert 1760).
double lambert(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Receiver& to) {
  const Vec3d w[3] = {(Vec3d(a) - Vec3d(to.p)).normalized(), (Vec3d(b) - Vec3d(to.p)).normalized(),
                      (Vec3d(c) - Vec3d(to.p)).normalized()};
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const Vec3d across = w[i].cross(w[(i + 1) % 3]);
    sum += std::atan2(across.length(), w[i].dot(w[(i + 1) % 3])) * across.normalized().dot(Vec3d(to.n));
  }
  return -0.5 * sum;  // below 0 from behind
}

/// A scene of small triangles over the plane y = 0, one primitive for each material, and its truth there.
struct Room {
  Scene scene;
  std::vector<std::array<Vec3f, 3>> triangles;
  std::vector<int> materials;

  Room(int count, std::uint32_t seed) {
    TestRandom random(seed);
    constexpr int kMaterials = 4;
    for (int i = 0; i < kMaterials; ++i) {
      add_material(scene, make_emitter(Rgb(std::pow(10.0f, float(i) / 2))));
      scene.materials.back().double_sided = i % 2 == 1;
    }
    std::vector<Vec3f> positions[kMaterials];
    const float size = 1 / std::sqrt(float(count));
    for (int i = 0; i < count; ++i) {
      const Vec2f u = random.next2();
      const Vec3f p(10 * u.x - 5, 0.3f + 2.5f * random.next1(), 10 * u.y - 5);
      const float reach = std::min(size, 0.5f * p.y);
      triangles.push_back({p, p + random.direction() * reach, p + random.direction() * reach});
      materials.push_back(i % kMaterials);
      for (const Vec3f& corner : triangles.back()) positions[i % kMaterials].push_back(corner);
    }
    for (int k = 0; k < kMaterials; ++k) {
      Primitive p;
      std::vector<Triangle> indices;
      for (std::uint32_t i = 0; i + 2 < positions[k].size(); i += 3) indices.push_back({i, i + 1, i + 2});
      p.positions = positions[k];
      p.triangles = indices;
      add_mesh(scene, p, k);
    }
  }

  double truth(const Receiver& to) const {
    double sum = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto& [a, b, c] = triangles[i];
      const Material& material = scene.materials[std::size_t(materials[i])];
      const double seen = lambert(a, b, c, to);
      sum += material.emission.x * (material.double_sided ? std::abs(seen) : std::max(0.0, seen));
    }
    return sum;
  }
};

const Vec3f kUp(0, 1, 0);

// With few and many numbers (kMaxLightsForOneNumber), with a normal and without.
TEST(ManyLights, AddUpWithoutBias) {
  for (const int count : {5, 40, 64, 65, 500}) {
    Room room(count, std::uint32_t(count));
    const auto truth = [&](const Receiver& to) {
      // A point light at (1, 2, 1); a spot that shines down from (2, 4, -3), whose falloff is glTF's; a
      // sphere of radius .3 and radiance 5; two suns, one of which shines from below; a constant sky.
      const Vec3d way = Vec3d(1, 2, 1) - Vec3d(to.p), spot = Vec3d(2, 4, -3) - Vec3d(to.p),
                  sphere = Vec3d(-2, 1, 1) - Vec3d(to.p);
      const double cosine = spot.y / spot.length(), inner = std::cos(0.3), outer = std::cos(0.8);
      const double t = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
      return room.truth(to) + 2 * way.y / std::pow(way.length(), 3) + 50 * t * t * cosine / spot.length2() +
             5 * kPiD * 0.09 * sphere.y / std::pow(sphere.length(), 3) + 0.5 * 0.8 + 0.1 * kPiD;
    };
    Light point, spot, sun;
    point.intensity = 2;
    spot.kind = LightKind::spot;
    spot.intensity = 50;
    spot.inner_angle = 0.3f;
    spot.outer_angle = 0.8f;
    add_light(room.scene, spot, look_along({2, 4, -3}, {0, -1, 0}));
    add_shape(room.scene, make_sphere(0.3f), add_material(room.scene, make_emitter(Rgb(5))),
              translate({-2, 1, 1}));
    sun.kind = LightKind::directional;
    sun.intensity = 0.5f;
    add_light(room.scene, point, translate({1, 2, 1}));
    add_light(room.scene, sun, look_along({0, 0, 0}, {0.6f, -0.8f, 0}));
    add_light(room.scene, sun, look_along({0, 0, 0}, {0.6f, 0.8f, 0}));
    room.scene.environment.radiance = Rgb(0.1f);
    const LitScene lit(room.scene);
    for (const Vec3f& p : {Vec3f(0), Vec3f(3, 0, -4), Vec3f(20, 0, 3)}) {
      const double expected = truth({p, kUp});
      EXPECT_TRUE(mean_is(irradiance(lit.table, {p, kUp}, kUp, 100000), expected, 0.03)) << count;
      EXPECT_TRUE(mean_is(irradiance(lit.table, {p, Vec3f(0)}, kUp, 100000), expected, 0.04)) << count;
    }
  }
}

TEST(ManyLights, TheTreeHasFarLessVarianceThanPower) {
  const Room room(10000, 1);
  const World world = make_world(room.scene);
  const LightTable tree(room.scene, world), power(room.scene, world, LightChoice::power),
      uniform(room.scene, world, LightChoice::uniform);
  double by_tree = 0, by_power = 0;
  for (int i = 0; i < 9; ++i) {
    const Receiver to{{float(i % 3 - 1) * 3.1f, 0, float(i / 3 - 1) * 2.9f}, kUp};
    const double truth = room.truth(to);
    const Statistics t = irradiance(tree, to, kUp, 20000), p = irradiance(power, to, kUp, 20000);
    EXPECT_TRUE(mean_is(t, truth, 0.05));
    EXPECT_NEAR(irradiance(uniform, to, kUp, 20000).mean(), truth, 0.5 * truth);
    by_tree += t.variance() / (truth * truth);
    by_power += p.variance() / (truth * truth);
  }
  std::printf("variance of power over that of the tree: %.1f\n", by_power / by_tree);
  EXPECT_GT(by_power, 10 * by_tree);
}

/// The probability that the sky is chosen, which is constant.
double sky_share(const LitScene& lit, const Receiver& to) {
  return double(lit.table.look_up_environment(kUp, to).pdf) * 4 * kPiD;
}

TEST(ManyLights, TheSkysShareDependsOnTheReceiver) {
  Scene scene;
  add_mesh(scene, make_quad({0, 1, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}),
           add_material(scene, make_emitter(Rgb(1))));
  add_mesh(scene, make_quad({2, 1, 0}, {0.5f, 0, 0}, {0, 0, 0.5f}), 0);
  scene.environment.radiance = Rgb(0.1f);
  const LitScene lit(scene);
  EXPECT_NEAR(sky_share(lit, {{0, 0.99f, 0}, kUp}), 0.1, 0.05) << "close to a lamp";
  EXPECT_NEAR(sky_share(lit, {{0, -100, 0}, kUp}), 0.9, 1e-5) << "far away";
  EXPECT_NEAR(sky_share(lit, {{0, 0, 0}, -kUp}), 1, 1e-6) << "turned away from all lamps";
  const double middle = sky_share(lit, {{0, -1, 0}, kUp});
  EXPECT_TRUE(middle > 0.15 && middle < 0.85) << middle;
}

TEST(ManyLights, ASunBehindTheReceiverIsNotChosen) {
  Scene scene;
  add_mesh(scene, make_box({-1, -6, -1}, {1, -5, 1}), add_material(scene, make_emitter(Rgb(1))));
  Light sun;
  sun.kind = LightKind::directional;
  add_light(scene, sun, look_along({0, 0, 0}, {0, -1, 0}));
  const LitScene lit(scene);
  int suns = 0, both = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    Sampler sampler(SamplerKind::independent, 1, 0, 0, i);
    const Vec2f u = sampler.next2();
    const auto below = lit.table.sample({Vec3f(0), -kUp}, u, sampler);
    suns += below && below->at_infinity;
    const auto all = lit.table.sample({Vec3f(0), Vec3f(0)}, u, sampler);
    both += all && all->at_infinity;
  }
  EXPECT_EQ(suns, 0);
  EXPECT_GT(both, 100);
}

// A double below 1 that is 1 as a float.
TEST(ManyLights, TheLargestNumberChoosesTheLastLight) {
  const LightChooser chooser(std::vector<float>(100, 1.0f));
  const LightChooser::Choice chosen = chooser.choose({}, 1 - 0x1p-48);
  EXPECT_EQ(chosen.light, 99);
  EXPECT_LT(chosen.remainder, 1);
}

TEST(ManyLights, WithoutPowerAreHarmless) {
  Scene scene;
  Light point;
  point.intensity = 0;
  for (int i = 0; i < 10; ++i) add_light(scene, point, translate({float(i), 1, 0}));
  const LitScene dark(scene);
  for (std::uint32_t i = 0; i < 100; ++i) EXPECT_FALSE(sample(dark, {0, 0, 0}, i));
  EXPECT_EQ(sky_share(dark, {Vec3f(0), kUp}), 0);
  scene.environment.radiance = Rgb(1);
  EXPECT_NEAR(sky_share(LitScene(scene), {Vec3f(0), kUp}), 1, 1e-6);
}

}  // namespace
}  // namespace parian
