// Differences of scenes: how much they hold, and what they read.
#include "editing/scene_delta.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <memory>
#include <string>

#include "editing/add.h"
#include "editing/nodes.h"
#include "editing/properties.h"
#include "renderer/session/session.h"
#include "tests/support/scenes.h"

namespace parian {
namespace {

template <class T>
std::size_t held(const ArrayDelta<T>& delta) {
  std::size_t count = 0;
  for (const Splice<T>& s : delta) count += s.before.size() + s.after.size();
  return count;
}

/// An array that nobody may look into.
template <class T>
SharedArray<T> closed_array(std::size_t size) {
  const std::size_t bytes = size * sizeof(T);
  void* memory = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  const std::shared_ptr<const void> owner(memory, [bytes](void* p) { munmap(p, bytes); });
  return {owner, static_cast<const T*>(memory), size};
}

/// A primitive of ten million triangles in closed memory beside a small one.
Scene scene_with_closed_mesh() {
  Scene scene;
  scene.materials.resize(2);
  Primitive large, small = make_box(Vec3f(0), Vec3f(1));
  large.positions = closed_array<Vec3f>(5'000'000);
  large.triangles = closed_array<Triangle>(10'000'000);
  large.material = small.material = 0;
  scene.meshes.push_back({});
  scene.meshes[0].primitives = {large, small};
  scene.nodes.emplace_back().mesh = 0;
  scene.nodes[0].instances = closed_array<InstanceTransform>(1'000'000);
  scene.roots = {0};
  return scene;
}

// Caught: contents compared (it ends in a crash).
TEST(SceneDelta, ReadsNoVertices) {
  const Scene before = scene_with_closed_mesh();
  Scene scene = before;
  scene.meshes[0].primitives[1].material = 1;
  EXPECT_EQ(changed(make_delta(before, scene)), unsigned(kChangedMaterials));
  scene.meshes[0].primitives[1] = make_box(Vec3f(0), Vec3f(2));
  scene.nodes[0].name = "instances";
  EXPECT_TRUE(changed(make_delta(before, scene)) & kChangedGeometry);
  const Scene other = scene_with_closed_mesh();
  const SceneDelta delta = make_delta(before, other);
  EXPECT_EQ(changed(delta), unsigned(kChangedGeometry));
  revert(scene = other, delta);
  EXPECT_EQ(scene.meshes[0].primitives[0].positions.data(), before.meshes[0].primitives[0].positions.data());
}

// A BVH may hold on to the old memory.
TEST(SceneDelta, EqualVerticesElsewhereAreAChange) {
  Scene before;
  before.materials.resize(1);
  add_mesh(before, make_box(Vec3f(0), Vec3f(1)), 0);
  Scene after = before;
  after.meshes[0].primitives[0].positions = std::vector<Vec3f>(
      before.meshes[0].primitives[0].positions.begin(), before.meshes[0].primitives[0].positions.end());
  ASSERT_TRUE(before == after);
  EXPECT_EQ(changed(make_delta(before, after)), unsigned(kChangedGeometry));
}

TEST(SceneDelta, OfEqualScenesIsEmpty) {
  const Scene scene = scene_with_closed_mesh();
  const SceneDelta delta = make_delta(scene, scene);
  EXPECT_TRUE(delta.empty());
  EXPECT_EQ(changed(delta), 0u);
}

Scene many_nodes(int count) {
  Scene scene;
  for (int i = 0; i < count; ++i) edit::add_group(scene, "node " + std::to_string(i));
  return scene;
}

// Of far apart edits no more is held than the nodes that they touch.
TEST(SceneDelta, HoldsWhatDiffers) {
  const Scene before = many_nodes(1000);
  Scene scene = before;
  const auto edit_of = [&](const auto& edit) {
    const SceneDelta delta = record(scene = before, edit);
    revert(scene, delta);
    EXPECT_TRUE(scene == before);
    return delta;
  };
  EXPECT_EQ(held(edit_of([](Scene& s) { edit::rename_node(s, 500, "x"); }).nodes), 2u);
  const SceneDelta ends = edit_of([](Scene& s) {
    edit::rename_node(s, 0, "first");
    edit::rename_node(s, 999, "last");
  });
  EXPECT_EQ(held(ends.nodes), 4u);
  EXPECT_EQ(held(edit_of([](Scene& s) { edit::add_group(s, "new", {0, {}}); }).nodes), 3u);
  EXPECT_EQ(held(edit_of([](Scene& s) { edit::remove(s, 300); }).nodes), 1u);
  EXPECT_EQ(held(edit_of([](Scene& s) { edit::reparent(s, 999, 0); }).nodes), 2u);
}

// One after the other, each on what the one before left.
TEST(SceneDelta, DeltasChain) {
  const Scene first = many_nodes(5);
  Scene scene = first;
  std::vector<SceneDelta> deltas;
  deltas.push_back(record(scene, [](Scene& s) { edit::add_shape(s, edit::sphere(1), {2, {}}); }));
  deltas.push_back(record(scene, [](Scene& s) { edit::remove(s, 2); }));
  deltas.push_back(record(scene, [](Scene& s) { s.environment.radiance = Rgb(1); }));
  const Scene last = scene;
  for (auto d = deltas.rbegin(); d != deltas.rend(); ++d) revert(scene, *d);
  EXPECT_TRUE(scene == first);
  for (const SceneDelta& d : deltas) apply(scene, d);
  EXPECT_TRUE(scene == last);
}

}  // namespace
}  // namespace parian
