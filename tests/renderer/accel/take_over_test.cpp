// What an edit takes over from the BVHs of before: that of which mesh, with what, and for how long.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "tests/renderer/accel/support/built.h"

namespace parian {
namespace {

/// The scene as an edit of that of `before`, which it takes BVHs over from.
Built edited_from(const Built& before, Scene scene) {
  Built built(std::move(scene), true);
  built.accel =
      std::make_unique<Accel>(built.scene, built.world, AccelSettings{.editable = true}, before.accel.get());
  return built;
}

/// Both primitives of one mesh: a half each of a ball of 3,120 triangles, of the same positions.
Scene two_halves() {
  const Primitive ball = make_uv_sphere({0, 0, 0}, 2.5f, 40);
  const auto middle = ball.triangles.begin() + std::ptrdiff_t(ball.triangles.size() / 2);
  Primitive upper = ball, lower = ball;
  lower.material = 0;
  upper.triangles = std::vector(ball.triangles.begin(), middle);
  lower.triangles = std::vector(middle, ball.triangles.end());
  Scene scene;
  add_material(scene, make_lambert({1, 1, 1}));
  add_mesh(scene, upper, 0, translate({1, 0, 1}));
  scene.meshes[0].primitives.push_back(lower);
  return scene;
}

SharedArray<Vec3f> stretched(const SharedArray<Vec3f>& positions, float by) {
  std::vector<Vec3f> result(positions.begin(), positions.end());
  for (Vec3f& p : result) p.y *= by;
  return result;
}

/// The edited scene is traced as if it never was another, and so many primitives were built for it.
void expect_edit_builds(const Scene& scene, const Scene& edited, int primitives) {
  const Built before(scene, true);
  const Built after = edited_from(before, edited);
  EXPECT_EQ(after.accel->builds().meshes - before.accel->builds().meshes, primitives);
  expect_same_hits(after, Built(edited, true));
  expect_same_hits(before, Built(scene, true));
}

// Caught: positions alone compared, triangles alone, addresses without sizes.
TEST(TakeOver, NotOfAMeshThatSharesSomeArraysAlone) {
  const Scene scene = two_halves();
  for (const std::size_t part : {0, 1}) {
    Scene moved = scene, cut = scene, shorter = scene;
    moved.meshes[0].primitives[part].positions = stretched(scene.meshes[0].primitives[part].positions, 1.3f);
    expect_edit_builds(scene, moved, 2);
    const SharedArray<Triangle>& all = scene.meshes[0].primitives[part].triangles;
    cut.meshes[0].primitives[part].triangles = std::vector(all.begin(), all.end() - 700);
    expect_edit_builds(scene, cut, 2);
    // The same memory, but less of it.
    shorter.meshes[0].primitives[part].triangles = {all.owner(), all.data(), all.size() - 700};
    expect_edit_builds(scene, shorter, 2);
  }
  Scene one = scene;
  one.meshes[0].primitives.pop_back();
  expect_edit_builds(scene, one, 1);
  expect_edit_builds(one, scene, 2);
  expect_edit_builds(scene, scene, 0);
}

/// Three poses of a ball, which share their triangles, and three parts of it, which share their positions.
Scene relatives() {
  const Primitive ball = make_uv_sphere({0, 0, 0}, 1.5f, 30);
  Scene scene;
  add_material(scene, make_lambert({1, 1, 1}));
  for (int i = 0; i < 3; ++i) {
    Primitive pose = ball, part = ball;
    pose.positions = stretched(ball.positions, 1.2f + 0.2f * float(i));
    const auto first = ball.triangles.begin() + 500 * i;
    part.triangles = std::vector(first, first + 500 + 100 * i);
    add_mesh(scene, pose, 0, translate({float(3 * i - 3), 2, 0}));
    add_mesh(scene, part, 0, translate({float(3 * i - 3), -2, 1}));
  }
  return scene;
}

/// The meshes in another order, shown by the same nodes.
Scene renumbered(Scene scene, const std::vector<int>& old_numbers) {
  std::vector<Mesh> meshes;
  for (const int old : old_numbers) meshes.push_back(scene.meshes[std::size_t(old)]);
  scene.meshes = std::move(meshes);
  for (Node& node : scene.nodes)
    node.mesh = int(std::ranges::find(old_numbers, node.mesh) - old_numbers.begin());
  return scene;
}

// Caught: only the first mesh of an array of triangles looked at; meshes told apart by nothing but that;
// meshes found by their numbers; copies in the first build built again.
TEST(TakeOver, OfMeshesThatShareArraysEachItsOwn) {
  const Scene scene = relatives();
  expect_edit_builds(scene, renumbered(scene, {5, 4, 3, 2, 1, 0}), 0);
  expect_edit_builds(scene, renumbered(scene, {2, 5, 0, 3, 4, 1}), 0);
  // Removed, and back behind others, of which one is new.
  Scene more = renumbered(scene, {1, 2, 3, 4, 5, 0});
  more.meshes.insert(more.meshes.begin(), {"", {make_uv_sphere({0, 0, 0}, 1, 10)}});
  more.meshes[0].primitives[0].material = 0;
  for (Node& node : more.nodes) ++node.mesh;
  Node node;
  node.mesh = 0;
  node.transform = translate({0, 0, 3});
  add_root(more, node);
  expect_edit_builds(scene, more, 1);
  // A mesh of the arrays of another one is built with it, in the first build too.
  Scene copied = scene;
  copied.meshes.push_back(scene.meshes[2]);
  node.mesh = int(scene.meshes.size());
  add_root(copied, node);
  EXPECT_EQ(Built(copied, true).accel->builds().meshes, 6);
  expect_edit_builds(scene, copied, 0);
}

/// Each hit is at its triangle's weights: those of the pairs' triangles.
void expect_hits_on_triangles(const Built& b) {
  TestRandom random(3);
  int second_halves = 0;
  for (int i = 0; i < 4000; ++i) {
    const Ray ray = random_ray(random, {-5, -5, -5}, {5, 5, 5});
    Hit hit{};
    if (!b.accel->intersect(ray, 0, hit)) continue;
    const Primitive& p = *b.world.part(hit.placement, hit.primitive).primitive;
    ASSERT_LT(hit.triangle, p.triangles.size());
    const Triangle& t = p.triangles[hit.triangle];
    const Vec3f point =
        p.positions[t[0]] * (1 - hit.u - hit.v) + p.positions[t[1]] * hit.u + p.positions[t[2]] * hit.v;
    const Vec3f seen = b.world.placements[hit.placement].to_world.point(point);
    ASSERT_LT((seen - (ray.o + ray.d * hit.t)).length(), 1e-4f) << "placement " << hit.placement;
    ASSERT_GE(std::min({hit.u, hit.v, 1 - hit.u - hit.v}), -1e-4f);
    second_halves += hit.triangle >= p.triangles.size() / 2;  // there are half as many pairs
  }
  EXPECT_GT(second_halves, 300);
}

// Caught: only what an edit builds has its way back.
TEST(TakeOver, PairsComeWithTheWayBackToTheirTriangles) {
  const Built first(two_halves(), true);
  expect_hits_on_triangles(first);
  // Nothing is built, one small mesh whose triangles are no pairs, and nothing again, with other numbers.
  Scene edited = first.scene;
  edited.nodes[0].transform = translate({0.5f, 0, 1});
  const Built moved = edited_from(first, edited);
  expect_hits_on_triangles(moved);
  add_mesh(edited, make_box({-3, -1, -1}, {-2, 1, 1}), 0);
  const Built added = edited_from(moved, edited);
  expect_hits_on_triangles(added);
  const Built swapped = edited_from(added, renumbered(edited, {1, 0}));
  expect_hits_on_triangles(swapped);
  EXPECT_EQ(swapped.accel->builds().meshes, 3);
  // Hidden with other numbers, and shown again with those of before.
  Scene hidden = edited;
  hidden.nodes[0].mesh = kNone;
  const Built without = edited_from(swapped, hidden);
  const Built shown = edited_from(without, renumbered(edited, {1, 0}));
  expect_hits_on_triangles(shown);
  EXPECT_EQ(shown.accel->builds().meshes, 3);
}

// The memory of the quick BVH, which takes half as much again as the better one, goes when that is adopted.
// Caught: instances left at the quick one, which no hit tells; the quick one held on to.
TEST(TakeOver, TheQuickBvhEndsWithTheBetterOne) {
  Scene scene;
  add_material(scene, make_lambert({1, 1, 1}));
  add_mesh(scene, make_uv_sphere({0, 0, 0}, 2, 180), 0);  // 128,880 triangles
  Node second;
  second.mesh = 0;
  second.transform = translate({3, 0, 0});
  add_root(scene, second);
  const Built b(scene, true);
  const std::size_t quick = b.accel->bytes();
  const std::atomic<bool> cancelled{false};
  {
    const Accel::Refined refined = b.accel->refine(1, cancelled);
    ASSERT_EQ(refined.size(), 1u);
    EXPECT_GT(b.accel->bytes(), quick);  // both
    b.accel->adopt(refined);
  }
  EXPECT_LT(b.accel->bytes(), quick);
}

}  // namespace
}  // namespace parian
