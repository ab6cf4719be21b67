// Edits: moved placements and area lights, other materials; what of it is built anew.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace parian
