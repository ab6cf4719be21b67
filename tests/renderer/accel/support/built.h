/// Scenes with what is built from them, and rays through them, for the tests of ray queries.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "renderer/accel/accel.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {

/// A scene with what is built from it.
struct Built {
  explicit Built(Scene s, bool editable = false) : scene(std::move(s)), world(make_world(scene)) {
    accel = std::make_unique<Accel>(scene, world, AccelSettings{editable});
  }
  Scene scene;
  World world;
  std::unique_ptr<Accel> accel;
};

/// Triangles around random points of the cube from -1 to 1, their corners `size` away from the point.
inline Primitive random_triangles(TestRandom& random, int count, float size) {
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

/// A transform that is the matrix (row-vector convention).
inline Transform matrix(const Imath::M44f& m) {
  Transform t;
  t.matrix = m;
  return t;
}

/// Meshes placed once and often: turned, stretched, mirrored, sheared, nested.
inline Scene many_placements(std::uint32_t seed) {
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

/// From a random point of the box towards another one.
inline Ray random_ray(TestRandom& random, const Vec3f& low, const Vec3f& high) {
  const auto point = [&] {
    return Vec3f(low.x + random.next1() * (high.x - low.x), low.y + random.next1() * (high.y - low.y),
                 low.z + random.next1() * (high.z - low.z));
  };
  const Vec3f origin = point();
  return {origin, normalize(point() - origin)};
}

/// Random rays, more than 1,000 of which must meet something, meet the same.
inline void expect_same_hits(const Built& a, const Built& b) {
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

/// A pane in the plane z = -depth that covers `alpha`.
inline void add_pane(Scene& scene, float depth, float alpha, AlphaMode mode = AlphaMode::blend) {
  Material m = make_lambert({1, 1, 1});
  m.alpha_mode = mode;
  m.alpha = alpha;
  add_mesh(scene, make_quad({0, 0, -depth}, {1, 0, 0}, {0, 1, 0}), add_material(scene, m));
}

/// A light of radiance 1; of a disk `width` is the diameter.
inline Light area_light(LightKind kind, float width, float height) {
  Light light;
  light.kind = kind;
  light.width = width;
  light.height = height;
  return light;
}

}  // namespace parian
