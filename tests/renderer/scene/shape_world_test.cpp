// Shapes as the tracer sees them: boxes and planes as meshes, the others as placed solids.
#include <gtest/gtest.h>

#include "renderer/scene/world.h"
#include "tests/support/scenes.h"

namespace parian {
namespace {

TEST(ShapeWorld, SolidsArePlacedOneByOne) {
  Scene scene;
  const int grey = add_material(scene, make_lambert({1, 1, 1}));
  const int glowing = add_material(scene, make_emitter({1, 1, 1}));
  Transform t = translate({1, 2, 3});
  t.rotation = Quatf(0.9f, 0.1f, -0.4f, 0.2f).normalized();
  t.scale = {2, 2, -2};
  const int ball = add_shape(scene, make_sphere(0.5f), grey, t);
  t.scale = {2, 1, 2};
  add_shape(scene, make_sphere(0.5f), glowing, t);
  const int cone = add_shape(scene, make_cylinder(1, 0, 2), grey);
  const World world = make_world(scene);
  EXPECT_TRUE(world.placements.empty());
  ASSERT_EQ(world.solids.size(), 3u);
  EXPECT_EQ(world.solids[0].node, ball);
  EXPECT_EQ(world.solids[2].node, cone);
  // A sphere stays one under a mirror and a uniform scale, and no other.
  EXPECT_FLOAT_EQ(world.solids[0].round_radius, 1);
  EXPECT_FALSE(world.solids[1].is_round());
  EXPECT_FALSE(world.solids[2].is_round());
  EXPECT_EQ(world.solids[0].part, world.solids[2].part);  // one material, one part
  EXPECT_FALSE(world.solid_parts[world.solids[0].part].emissive);
  EXPECT_TRUE(world.solid_parts[world.solids[1].part].emissive);
  // Nor under one that is not quite uniform: what counts as round is so within its error bound.
  scene.nodes[0].transform.scale = {2, 2.00001f, 2};
  EXPECT_FALSE(make_world(scene).solids[0].is_round());
  // The point of the ball that faces a direction is found in its own space, the mirror included.
  const PlacedSolid& round = world.solids[0];
  const Vec3f q = normalize(Vec3f(0.3f, -0.2f, 0.7f)) * 0.5f;
  EXPECT_LT((round.round_point(normalize(round.to_world.vector(q))) - q).length(), 1e-6f);
  EXPECT_LT((world.bounds.min - Vec3f(-1, -1, -1)).length(), 1.5f);
  EXPECT_NEAR(world.bounds.max.z, 4, 1e-5);
}

TEST(ShapeWorld, BoxesOfOneMaterialShareAMesh) {
  Scene scene;
  add_mesh(scene, make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), add_material(scene, Material{}));
  const int other = add_material(scene, Material{});
  add_shape(scene, make_flat_shape(ShapeKind::box, {1, 2, 3}), 0);
  Node again = scene.nodes.back();
  again.transform = translate({5, 0, 0});
  add_root(scene, again);
  again.shape_material = other;
  again.transform = translate({-5, 0, 0});
  add_root(scene, again);
  add_shape(scene, make_flat_shape(ShapeKind::plane, {4, 0, 6}), 0);
  const World world = make_world(scene);
  ASSERT_EQ(world.placements.size(), 5u);
  EXPECT_EQ(world.mesh_count(scene), 4u);
  EXPECT_EQ(world.placements[1].mesh, 1);
  EXPECT_EQ(world.placements[2].mesh, 1);
  EXPECT_EQ(world.placements[3].mesh, 2);
  EXPECT_EQ(world.placements[4].mesh, 3);
  EXPECT_EQ(world.part(1, 0).primitive, world.part(2, 0).primitive);
  EXPECT_EQ(world.part(3, 0).material_index, other);
  EXPECT_EQ(world.part(1, 0).primitive->triangles.size(), 12u);
  EXPECT_EQ(world.part(4, 0).primitive->triangles.size(), 2u);
  EXPECT_EQ(world.slot_count, 5u);
  EXPECT_EQ(world.bounds.min, Vec3f(-5.5f, -1, -3));
  EXPECT_EQ(world.bounds.max, Vec3f(5.5f, 1, 3));
  // The same again where bounds of meshes are taken over.
  const World same = make_world(scene, &world);
  EXPECT_EQ(same.bounds.max, world.bounds.max);
}

// The triangles of a box face outwards, cover its faces, and carry the whole texture upright on each side.
TEST(ShapeWorld, BoxesAreExact) {
  Scene scene;
  add_shape(scene, make_flat_shape(ShapeKind::box, {1, 2, 3}), add_material(scene, Material{}));
  const World world = make_world(scene);
  const Primitive& box = *world.part(0, 0).primitive;
  double area = 0, volume = 0;
  for (const Triangle& t : box.triangles) {
    const Vec3f &a = box.positions[t[0]], &b = box.positions[t[1]], &c = box.positions[t[2]];
    const Vec3f n = (b - a).cross(c - a);
    EXPECT_GT(n.dot(a + b + c), 0);
    area += 0.5 * n.length();
    volume += a.dot(b.cross(c)) / 6;
    // In uv, counter-clockwise on the page (v downwards): not mirrored.
    const Vec2f e1 = box.uvs[0][t[1]] - box.uvs[0][t[0]], e2 = box.uvs[0][t[2]] - box.uvs[0][t[0]];
    EXPECT_LT(e1.x * e2.y - e1.y * e2.x, 0);
    EXPECT_NEAR(std::abs(e1.x * e2.y - e1.y * e2.x), 1, 1e-6);
    for (const std::uint32_t v : t)
      if (std::abs(n.normalized().y) < 0.5f) {
        EXPECT_EQ(box.uvs[0][v].y, box.positions[v].y > 0 ? 0 : 1);
      }
  }
  EXPECT_NEAR(area, 22, 1e-5);
  EXPECT_NEAR(volume, 6, 1e-5);
}

TEST(ShapeWorld, PlanesFaceUpWithUAlongXAndVAlongZ) {
  Scene scene;
  add_shape(scene, make_flat_shape(ShapeKind::plane, {4, 0, 6}), add_material(scene, Material{}));
  const World world = make_world(scene);
  const Primitive& plane = *world.part(0, 0).primitive;
  for (const Triangle& t : plane.triangles) {
    const Vec3f &a = plane.positions[t[0]], &b = plane.positions[t[1]], &c = plane.positions[t[2]];
    EXPECT_GT((b - a).cross(c - a).y, 0);
  }
  for (std::size_t i = 0; i < plane.positions.size(); ++i) {
    EXPECT_FLOAT_EQ(plane.uvs[0][i].x, plane.positions[i].x / 4 + 0.5f);
    EXPECT_FLOAT_EQ(plane.uvs[0][i].y, plane.positions[i].z / 6 + 0.5f);
  }
}

TEST(ShapeWorld, InstancesDrawAShapeOnceEach) {
  Scene scene;
  add_shape(scene, make_sphere(1), add_material(scene, Material{}), translate({0, 1, 0}));
  scene.nodes[0].instances = instances({translate({1, 0, 0}), translate({2, 0, 0}), scale({0, 1, 1})});
  const World world = make_world(scene);
  ASSERT_EQ(world.solids.size(), 2u);  // the third is hidden: a scale of zero
  EXPECT_EQ(world.solids[1].to_world.origin, Vec3f(2, 1, 0));
}

TEST(ShapeWorld, AGlowingSolidIsALight) {
  Scene scene;
  add_shape(scene, make_sphere(1), add_material(scene, make_emitter({1, 1, 1})));
  Scene dark = scene;
  EXPECT_EQ(add_missing_camera_and_light(scene).size(), 1u);  // the camera
  dark.materials[0].emission = Rgb(0, 0, 0);
  EXPECT_EQ(add_missing_camera_and_light(dark).size(), 2u);
}

}  // namespace
}  // namespace parian
