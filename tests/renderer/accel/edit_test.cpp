// Edits: moved placements and area lights, other materials; what of it is built anew.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <utility>

#include "tests/renderer/accel/support/built.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// Meshes placed once and often, and two area lights.
Scene editable_scene() {
  Scene scene = many_placements(9);
  add_light(scene, area_light(LightKind::disk, 2, 1), translate({0, 3, 0}));
  add_light(scene, area_light(LightKind::rectangle, 1, 1), translate({0, -3, 0}));
  return scene;
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

/// A bumpy sphere of so many rings in a mesh of its own.
int add_ball(Scene& scene, int rings, const Transform& transform) {
  Primitive ball = make_uv_sphere({0, 0, 0}, 2, rings);
  return add_mesh(scene, std::move(ball), 0, transform);
}

TEST(Accel, AnEditTakesOverTheBvhsOfMeshes) {
  Scene scene = editable_scene();
  Built b(scene, true);
  const int before = b.accel->builds().meshes;
  Scene edited = scene;
  const int ball = add_ball(edited, 12, translate({0, 0, 2}));
  std::swap(edited.meshes[0], edited.meshes[2]);  // other numbers
  for (Node& node : edited.nodes)
    if (node.mesh == 0 || node.mesh == 2) node.mesh = 2 - node.mesh;
  edited.nodes[1].mesh = kNone;
  add_shape(edited, make_sphere(0.5f), 0, translate({0, 1, 0}));
  add_light(edited, area_light(LightKind::disk, 1, 1), translate({1, 1, 1}));
  const AccelSettings settings{.editable = true};
  Built after(scene, true);  // its scene and world are replaced
  after.scene = edited;
  after.world = make_world(after.scene);
  after.accel = std::make_unique<Accel>(after.scene, after.world, settings, b.accel.get());
  EXPECT_EQ(after.accel->builds().meshes, before + 1);
  const Built fresh(edited, true);
  expect_same_hits(after, fresh);
  // The one before is as it was.
  const Built original(scene, true);
  expect_same_hits(b, original);

  // Hidden, shown again, and copied with another material and with alpha: nothing is built.
  Scene hidden = edited;
  hidden.nodes[std::size_t(ball)].mesh = kNone;
  const World without = make_world(hidden);
  const Accel second(hidden, without, settings, after.accel.get());
  Scene copied = edited;
  Mesh copy = copied.meshes[std::size_t(edited.nodes[std::size_t(ball)].mesh)];
  Material pane = make_lambert({1, 1, 1});
  pane.alpha_mode = AlphaMode::blend;
  pane.alpha = 0;
  copy.primitives[0].material = add_material(copied, pane);
  copied.meshes.push_back(copy);
  Node node;
  node.mesh = int(copied.meshes.size()) - 1;
  node.transform = translate({3, 3, 3});
  add_root(copied, node);
  const World with_copy = make_world(copied);
  const Accel third(copied, with_copy, settings, &second);
  EXPECT_EQ(third.builds().meshes, before + 1);
  Hit hit;
  EXPECT_TRUE(third.intersect({{0, 0, 9}, {0, 0, -1}}, 1, hit));
  EXPECT_FALSE(third.occluded({{3, 3, 9}, {0, 0, -1}, 12}, 1));  // nothing of it is there
}

TEST(Accel, LargeMeshesAreRefined) {
  Scene scene;
  add_material(scene, make_lambert({1, 1, 1}));
  add_ball(scene, 12, translate({2, 0, 0}));
  add_ball(scene, 180, translate({-1, 0, 0}));  // 128,880 triangles
  Built b(scene, true);
  const Built unrefined(scene, true);
  ASSERT_TRUE(b.accel->can_refine());
  const std::atomic<bool> cancelled{true}, wanted{false};
  EXPECT_THROW(b.accel->refine(1, cancelled), BuildCancelled);
  const Accel::Refined refined = b.accel->refine(1, wanted);
  ASSERT_EQ(refined.size(), 1u);
  b.accel->adopt(refined);
  EXPECT_FALSE(b.accel->can_refine());
  EXPECT_EQ(b.accel->builds().refined, 1);
  expect_same_hits(b, unrefined);
  // One that comes too late for its mesh is dropped.
  Scene other = scene;
  other.nodes.resize(1), other.roots.resize(1), other.meshes.resize(1);
  Built small(other, true);
  small.accel->adopt(refined);
  EXPECT_EQ(small.accel->builds().refined, 0);
}

TEST(Accel, ABuildCanBeCancelled) {
  Scene scene;
  add_material(scene, make_lambert({1, 1, 1}));
  add_ball(scene, 100, {});
  const World world = make_world(scene);
  const std::atomic<bool> cancelled{true};
  EXPECT_THROW(Accel(scene, world, AccelSettings{.editable = true}, nullptr, &cancelled), BuildCancelled);
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

}  // namespace
}  // namespace parian
