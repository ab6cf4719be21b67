// Everything that a ray crosses: each surface at each place once, whatever holds it in the BVH.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>

#include "tests/renderer/accel/support/built.h"

namespace parian {
namespace {

/// A world is built for the query only where it has media.
int add_glass(Scene& scene) {
  Material m = make_lambert({1, 1, 1});
  m.transmission.emplace();
  m.volume.emplace().thickness = 1;
  return add_material(scene, m);
}

struct Crossed {
  float t;
  std::uint32_t placement;
  bool entering;
  bool operator==(const Crossed&) const = default;
};

std::vector<Crossed> crossings(const Built& built, const Ray& ray) {
  std::array<Hit, 64> hits;
  const std::size_t count = built.accel->crossings(ray, 0, hits);
  std::vector<Crossed> all;
  for (const Hit& hit : std::span(hits).first(count)) {
    const bool light = hit.placement == Hit::kAreaLightHit;
    all.push_back({hit.t, hit.placement, !light && ray.d.dot(hit_normal(built.world, hit)) < 0});
  }
  std::ranges::sort(all, {}, &Crossed::t);
  return all;
}

// Spheres that are round, a solid that needs its map, a mesh drawn once and one drawn twice, all on one line.
TEST(Crossings, AreAllThatLieOnTheRay) {
  Scene scene;
  const int glass = add_glass(scene);
  add_shape(scene, make_sphere(0.5f), glass, translate({2, 0, 0}));
  Transform squashed = translate({4, 0, 0});
  squashed.scale = {0.5f, 1, 1};
  add_shape(scene, make_sphere(0.5f), glass, squashed);
  add_mesh(scene, make_box({5.5f, -1, -1}, {6.5f, 1, 1}), glass);
  add_mesh(scene, make_box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}), glass, translate({8, 0, 0}));
  Node again;
  again.mesh = 1;
  again.transform = translate({10, 0, 0});
  again.transform.scale = {-1, 1, 1};
  add_root(scene, again);
  const Built built(std::move(scene));

  // Off the boxes' diagonals, which two triangles share.
  const std::vector<Crossed> all = crossings(built, {{0, 0.1f, 0.03f}, {1, 0, 0}});
  const double half = std::sqrt(0.25 - 0.01 - 0.0009);
  const double truths[] = {2 - half, 2 + half, 4 - half / 2, 4 + half / 2, 5.5, 6.5, 7.5, 8.5, 9.5, 10.5};
  ASSERT_EQ(all.size(), std::size(truths));
  for (std::size_t i = 0; i < all.size(); ++i) {
    EXPECT_NEAR(all[i].t, truths[i], 1e-5);
    EXPECT_EQ(all[i].entering, i % 2 == 0) << i;
    EXPECT_EQ(all[i].placement, all[i ^ 1].placement) << i;
  }
  EXPECT_EQ(crossings(built, {{2, 0.1f, 0.03f}, {1, 0, 0}, 2}).size(), 2u) << "only between the ends";
  EXPECT_TRUE(crossings(built, {{0, 3, 0}, {1, 0, 0}}).empty());
}

// Two surfaces in exactly one place are both there, which the nearest hit alone cannot say.
TEST(Crossings, InOnePlaceAreAllThere) {
  Scene scene;
  const int glass = add_glass(scene), other = add_material(scene, make_lambert({1, 1, 1}));
  add_mesh(scene, make_box({-1, 0, -1}, {1, 1, 1}), glass);
  add_mesh(scene, make_box({-1, -1, -1}, {1, 0, 1}), other);
  const Built built(std::move(scene));
  const std::vector<Crossed> all = crossings(built, {{0.2f, 1e-3f, 0.1f}, {0, -1, 0}, 2e-3f});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_NE(all[0].placement, all[1].placement);
  EXPECT_NE(all[0].entering, all[1].entering);
}

// What alpha cuts away is not crossed. Where there is no room for all, each has the same chance to be kept:
// here 1/2; the tolerance is 5 standard errors.
TEST(Crossings, RespectAlphaAndTheRoomGiven) {
  Scene scene;
  add_mesh(scene, make_quad({0, 0, -20}, {1, 0, 0}, {0, 1, 0}), add_glass(scene));
  for (int i = 1; i <= 10; ++i) add_pane(scene, float(i), i % 2 == 0 ? 1 : 0);
  const Built built(std::move(scene));
  const Ray ray{{0.1f, 0.2f, 0}, {0, 0, -1}};
  EXPECT_EQ(crossings(built, ray).size(), 6u);
  std::array<Hit, 3> few;
  std::map<float, int> kept;
  constexpr int kRays = 20000;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    EXPECT_EQ(built.accel->crossings(ray, hash32(i), few), 6u);
    for (const Hit& hit : few) ++kept[hit.t];
  }
  EXPECT_EQ(kept.size(), 6u);
  for (const auto& [t, count] : kept) EXPECT_NEAR(count, kRays / 2, 5 * std::sqrt(kRays / 4.0)) << t;
}

// Ten thousand layers of one body, of which there is room for sixteen; and none of another body in between.
TEST(Crossings, OfOneBodyAreThoseAlone) {
  Scene scene;
  const int glass = add_glass(scene);
  Primitive layers;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  constexpr std::uint32_t kLayers = 10000;
  for (std::uint32_t i = 0; i < kLayers; ++i) {
    for (const Vec2f& p : {Vec2f(-1, -1), Vec2f(3, -1), Vec2f(-1, 3)})
      positions.push_back({p.x, p.y, -1 - 1e-3f * float(i)});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  layers.positions = positions;
  layers.triangles = triangles;
  add_mesh(scene, layers, glass);
  add_mesh(scene, make_box({-1, -1, -4}, {1, 1, -3}), glass);
  const Built built(std::move(scene));
  const Ray ray{{0.1f, 0.2f, 0}, {0, 0, -1}};
  std::array<Hit, 16> some;
  const Body body{0, built.world.part(0, 0).medium}, other{1, built.world.part(1, 0).medium};
  EXPECT_EQ(built.accel->crossings(ray, 1, some, &body), kLayers);
  for (const Hit& hit : some) EXPECT_EQ(hit.placement, 0u);
  EXPECT_EQ(built.accel->crossings(ray, 1, some, &other), 2u);
}

}  // namespace
}  // namespace parian
