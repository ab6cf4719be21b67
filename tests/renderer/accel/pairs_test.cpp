// Triangles traced in pairs: how they are paired, and where a hit on a quad is on its triangle.
#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/accel/triangle_pairs.h"
#include "tests/renderer/accel/support/built.h"

namespace parian {
namespace {

/// A wavy grid of n x n squares of two triangles each, uv and all corners distinct.
Primitive make_grid(int n) {
  Primitive p;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x)
      positions.emplace_back(2 * float(x) / float(n) - 1, 2 * float(y) / float(n) - 1,
                             0.1f * std::sin(0.7f * float(x) + 1.3f * float(y)));
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto a = std::uint32_t(y * (n + 1) + x), b = a + 1, c = a + std::uint32_t(n) + 2, d = c - 1;
      triangles.push_back({a, b, c});
      triangles.push_back({c, d, a});
    }
  p.positions = std::move(positions);
  p.triangles = std::move(triangles);
  return p;
}

TrianglePairs find_pairs(const SharedArray<Triangle>& triangles) {
  TrianglePairs pairs = pair_triangles(triangles);
  find_origins(pairs, triangles);
  return pairs;
}

std::vector<int> uses_of(const TrianglePairs& pairs, std::size_t triangles) {
  std::vector<int> uses(triangles, 0);
  for (std::size_t q = 0; q < pairs.quads.size(); ++q) {
    ++uses[pairs.origins[q].first];
    if (pairs.origins[q].step) ++uses[pairs.origins[q].first + pairs.origins[q].step];
  }
  return uses;
}

TEST(TrianglePairs, PairsEachTriangleOfASquareWithTheOther) {
  const Primitive grid = make_grid(300);  // several chunks
  const TrianglePairs pairs = find_pairs(grid.triangles);
  EXPECT_EQ(pairs.quads.size(), 300u * 300u);
  EXPECT_TRUE(std::ranges::all_of(pairs.origins, [](const PairOrigin& o) { return o.step == 1; }));
  EXPECT_TRUE(std::ranges::all_of(uses_of(pairs, grid.triangles.size()), [](int n) { return n == 1; }));
  EXPECT_EQ(estimate_quads(grid.triangles), 300.0 * 300.0);
}

TEST(TrianglePairs, HasEachTriangleOnceWhateverTheirOrder) {
  Primitive grid = make_grid(60);
  std::vector<Triangle> triangles(grid.triangles.begin(), grid.triangles.end());
  TestRandom random(3);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::swap(triangles[i], triangles[std::min(triangles.size() - 1, i + std::size_t(random.next1() * 12))]);
    if (random.next1() < 0.5f) std::swap(triangles[i][0], triangles[i][1]);  // wound the other way
    std::ranges::rotate(triangles[i], triangles[i].begin() + int(random.next1() * 3));
  }
  const SharedArray<Triangle> array(triangles);
  const TrianglePairs pairs = find_pairs(array);
  EXPECT_TRUE(std::ranges::all_of(uses_of(pairs, triangles.size()), [](int n) { return n == 1; }));
  EXPECT_LT(pairs.quads.size(), triangles.size() * 3 / 4);
  for (std::size_t q = 0; q < pairs.quads.size(); ++q) {
    Triangle first = triangles[pairs.origins[q].first];
    Triangle half{pairs.quads[q][0], pairs.quads[q][1], pairs.quads[q][3]};
    std::ranges::sort(first);
    std::ranges::sort(half);
    EXPECT_EQ(first, half);
    if (!pairs.origins[q].step) continue;
    Triangle second = triangles[pairs.origins[q].first + pairs.origins[q].step],
             other{pairs.quads[q][2], pairs.quads[q][3], pairs.quads[q][1]};
    std::ranges::sort(second);
    std::ranges::sort(other);
    EXPECT_EQ(second, other);
  }
}

TEST(TrianglePairs, LeavesAloneWhatSharesNoEdgeOrHasNoArea) {
  const std::vector<Triangle> apart{{0, 1, 2}, {2, 3, 4}, {5, 5, 6}, {5, 6, 7}, {8, 9, 10}, {8, 9, 10}};
  const TrianglePairs pairs = find_pairs(SharedArray<Triangle>(apart));
  ASSERT_EQ(pairs.quads.size(), apart.size());
  for (std::size_t q = 0; q < apart.size(); ++q) {
    EXPECT_EQ(pairs.origins[q].step, 0);
    EXPECT_EQ(pairs.quads[q], (Quad{apart[q][0], apart[q][1], apart[q][2], apart[q][2]}));
  }
}

// The hit's triangle and weights give the point of the ray: in both halves, for every order and winding of
// the corners. Caught: u and v of the second half not turned back, its weights exchanged, the corner
// forgotten.
TEST(TrianglePairs, HitsLieOnTheRay) {
  Primitive grid = make_grid(24);
  std::vector<Triangle> triangles(grid.triangles.begin(), grid.triangles.end());
  TestRandom random(11);
  for (Triangle& t : triangles) {
    if (random.next1() < 0.5f) std::swap(t[0], t[1]);
    std::ranges::rotate(t, t.begin() + int(random.next1() * 3));
  }
  grid.triangles = triangles;
  Scene scene;
  grid.material = add_material(scene, make_lambert({1, 1, 1}));
  add_mesh(scene, grid, grid.material);
  const Built built(std::move(scene));
  std::vector<int> hits(triangles.size(), 0);
  for (int i = 0; i < 60000; ++i) {
    const Ray ray{{2 * random.next1() - 1, 2 * random.next1() - 1, 3},
                  normalize(Vec3f(0.2f * random.next1() - 0.1f, 0.2f * random.next1() - 0.1f, -1))};
    Hit hit;
    if (!built.accel->intersect(ray, 0, hit)) continue;
    ++hits[hit.triangle];
    const Triangle& t = triangles[hit.triangle];
    const Vec3f p = grid.positions[t[0]] * (1 - hit.u - hit.v) + grid.positions[t[1]] * hit.u +
                    grid.positions[t[2]] * hit.v;
    EXPECT_LT((p - (ray.o + ray.d * hit.t)).length(), 2e-6f);
    EXPECT_GE(std::min({hit.u, hit.v, 1 - hit.u - hit.v}), -1e-5f);
  }
  EXPECT_GT(*std::ranges::min_element(hits), 5);
}

// A mesh of loose triangles is traced as it is, one of squares in pairs: it takes less.
TEST(TrianglePairs, TakeLessMemoryWhereTheyAre) {
  const auto bytes = [](Primitive p) {
    Scene scene;
    p.material = add_material(scene, make_lambert({1, 1, 1}));
    const double triangles = double(p.triangles.size());
    add_mesh(scene, p, p.material);
    const Built built(std::move(scene));
    return double(built.accel->bytes()) / triangles;
  };
  TestRandom random(5);
  EXPECT_LT(bytes(make_grid(200)), 0.85 * bytes(random_triangles(random, 80000, 0.01f)));
}

// Within 10%, for all that a build may be. Caught: the pairs left out.
TEST(AccelMemory, IsAsEstimated) {
  TestRandom random(7);
  for (const bool paired : {true, false})
    for (const BuildQuality quality : {BuildQuality::fast, BuildQuality::balanced, BuildQuality::best})
      for (const bool compact : {false, true}) {
        Scene scene;
        Primitive p = paired ? make_grid(500) : random_triangles(random, 400000, 0.01f);
        p.material = add_material(scene, make_lambert({1, 1, 1}));
        add_mesh(scene, p, p.material);
        const World world = make_world(scene);
        const AccelSettings settings{.quality = quality, .compact = compact};
        const Accel accel(scene, world, settings);
        const AccelMemory estimate = estimate_memory(scene, world, settings);
        EXPECT_NEAR(double(estimate.held) / double(accel.bytes()), 1, 0.1)
            << "paired " << paired << " quality " << int(quality) << " compact " << compact;
        EXPECT_GE(estimate.peak, estimate.held);
      }
}

}  // namespace
}  // namespace parian
