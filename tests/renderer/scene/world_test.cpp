#include "renderer/scene/world.h"

#include <gtest/gtest.h>

#include "renderer/scene/camera.h"
#include "tests/support/scenes.h"

namespace parian {
namespace {

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance = 1e-5f) {
  EXPECT_LE((a - b).length(), tolerance)
      << "(" << a.x << ", " << a.y << ", " << a.z << ") is not (" << b.x << ", " << b.y << ", " << b.z << ")";
}

Transform turn(const Vec3f& axis, float angle) {
  Transform t;
  t.rotation.setAxisAngle(axis, angle);
  return t;
}

/// A scene of one triangle mesh of one plain material, not yet shown.
Scene make_scene() {
  Scene scene;
  add_material(scene, make_lambert({1, 1, 1}));
  Primitive p = make_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  p.material = 0;
  scene.meshes.push_back({"", {p}});
  return scene;
}

Node mesh_node(const Transform& transform = {}, int mesh = 0) {
  Node node;
  node.mesh = mesh;
  node.transform = transform;
  return node;
}

// --- Nodes ---

// Catches matrices multiplied in the wrong order.
TEST(World, NestsTransformsParentsLast) {
  Scene scene = make_scene();
  const int child = add_root(scene, mesh_node(scale({2, 3, 4})));
  scene.roots.clear();
  Node parent;
  parent.transform = turn({0, 0, 1}, kPi / 2);
  parent.transform.translation = {10, 0, 0};
  parent.children = {child};
  const int middle = add_root(scene, parent);
  scene.roots.clear();
  Node top;
  top.transform.matrix = Imath::M44f(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 7, 1);
  top.children = {middle};
  add_root(scene, top);
  const World world = make_world(scene);
  ASSERT_EQ(world.placements.size(), 1u);
  const Placement& p = world.placements[0];
  EXPECT_EQ(p.node, child);
  EXPECT_FALSE(p.identity);
  // x: doubled, turned to +y, moved by 10, then by 7 in z.
  expect_near(p.to_world.point({1, 0, 0}), {10, 2, 7});
  expect_near(p.to_world.point({0, 1, 0}), {7, 0, 7});
  expect_near(p.to_world.point({0, 0, 1}), {10, 0, 11});
  expect_near(world.bounds.min, {7, 0, 7});
  expect_near(world.bounds.max, {10, 2, 7});
}

// EXT_mesh_gpu_instancing: an instance's transform comes before the node's.
TEST(World, PlacesEveryInstance) {
  Scene scene = make_scene();
  Node node = mesh_node(turn({0, 0, 1}, kPi / 2));
  node.instances = instances({translate({5, 0, 0}), scale({2, 2, 2}), {}});
  add_root(scene, node);
  add_root(scene, mesh_node());
  const World world = make_world(scene);
  ASSERT_EQ(world.placements.size(), 4u);
  expect_near(world.placements[0].to_world.point({1, 0, 0}), {0, 6, 0});
  expect_near(world.placements[1].to_world.point({1, 0, 0}), {0, 2, 0});
  expect_near(world.placements[2].to_world.point({1, 0, 0}), {0, 1, 0});
  EXPECT_TRUE(world.placements[3].identity);
  EXPECT_EQ(world.parts.size(), 1u) << "the mesh is there once";
}

TEST(World, ShowsOnlyWhatHangsOnARoot) {
  Scene scene = make_scene();
  scene.nodes.push_back(mesh_node());
  EXPECT_TRUE(make_world(scene).placements.empty());
  EXPECT_TRUE(make_world(scene).bounds.isEmpty());
  scene.roots = {0};
  EXPECT_EQ(make_world(scene).placements.size(), 1u);
}

// What is not visible hides all that is below it, but for cameras.
TEST(World, HidesWhatIsNotVisible) {
  Scene scene = make_scene();
  scene.lights.emplace_back();
  scene.shapes.emplace_back();
  scene.cameras.emplace_back();
  Node node = mesh_node();
  node.light = node.shape = node.shape_material = node.camera = 0;
  const int child = add_root(scene, node);
  scene.roots.clear();
  Node parent;
  parent.children = {child};
  const int root = add_root(scene, parent);
  const auto expect = [&](std::size_t count) {
    const World world = make_world(scene);
    EXPECT_EQ(world.placements.size(), count);
    EXPECT_EQ(world.solids.size(), count);
    EXPECT_EQ(world.punctual_lights.size(), count);
    EXPECT_EQ(world.cameras.size(), 1u);
  };
  expect(1);
  scene.nodes[root].visible = false;
  expect(0);
  scene.nodes[root].visible = true;
  scene.nodes[child].visible = false;
  expect(0);
}

// A flat scale leaves nothing to hit; a tiny one still does.
TEST(World, HidesMeshesOfZeroScale) {
  Scene scene = make_scene();
  add_root(scene, mesh_node(scale({1, 0, 1})));
  add_root(scene, mesh_node(scale({0, 0, 0})));
  Node node = mesh_node();
  node.instances = instances({scale({0, 1, 1}), translate({3, 0, 0})});
  add_root(scene, node);
  add_root(scene, mesh_node(scale({1e-6f, 1e-6f, 1e-6f})));
  const World world = make_world(scene);
  ASSERT_EQ(world.placements.size(), 2u);
  expect_near(world.placements[0].to_world.origin, {3, 0, 0});
  EXPECT_EQ(world.placements[1].node, 3);
  expect_near(world.bounds.max, {4, 1, 0});
}

// Parts follow the meshes, slots the placements; both count primitives.
TEST(World, NumbersPartsAndSlots) {
  Scene scene = make_scene();
  const int other = add_material(scene, make_emitter({1, 1, 1}));
  Primitive two = scene.meshes[0].primitives[0];
  two.material = other;
  scene.meshes.push_back({"", {scene.meshes[0].primitives[0], two, two}});
  add_root(scene, mesh_node({}, 1));
  add_root(scene, mesh_node({}, 0));
  add_root(scene, mesh_node({}, 1));
  const World world = make_world(scene);
  ASSERT_EQ(world.parts.size(), 4u);
  EXPECT_EQ(world.placements[0].first_part, 1u);
  EXPECT_EQ(world.placements[1].first_part, 0u);
  EXPECT_EQ(world.placements[2].first_part, 1u);
  EXPECT_EQ(world.placements[0].first_slot, 0u);
  EXPECT_EQ(world.placements[1].first_slot, 3u);
  EXPECT_EQ(world.placements[2].first_slot, 4u);
  EXPECT_EQ(world.slot_count, 7u);
  EXPECT_EQ(world.part(2, 1).material_index, other);
  EXPECT_EQ(world.part(2, 0).material_index, 0);
  EXPECT_TRUE(world.part(0, 2).emissive);
}

TEST(World, KnowsWhatAHitNeeds) {
  Scene scene = make_scene();
  const TextureRef texture = add_texture(scene, make_image<std::uint8_t>(1, 1, 1, PixelType::u8, {1}));
  const auto part = [&](const Material& material, bool colors = false) {
    scene.materials[0] = material;
    scene.meshes[0].primitives[0].colors = colors ? std::vector<Vec4f>(3, Vec4f(1)) : std::vector<Vec4f>();
    Part p = make_world(scene).parts.at(0);
    return std::array{p.needs_uv, p.needs_color, p.needs_tangent, p.emissive, p.alpha};
  };
  using Flags = std::array<bool, 5>;
  Material m;
  EXPECT_EQ(part(m), (Flags{false, false, false, false, false}));
  EXPECT_EQ(part(m, true), (Flags{false, true, false, false, false}));
  for (TextureRef Material::*ref :
       {&Material::base_color_texture, &Material::metallic_roughness_texture, &Material::normal_texture,
        &Material::emission_texture, &Material::specular_texture, &Material::specular_color_texture}) {
    Material textured;
    textured.*ref = texture;
    EXPECT_EQ(part(textured), (Flags{true, false, ref == &Material::normal_texture, false, false}));
  }
  m.emission = {0, 0, 1};
  EXPECT_EQ(part(m), (Flags{false, false, false, true, false}));
  m.unlit = true;
  EXPECT_EQ(part(m), (Flags{false, false, false, false, false})) << "unlit: no light transport";

  Material alpha;
  alpha.alpha = 0.5f;
  EXPECT_FALSE(part(alpha)[4]) << "OPAQUE ignores alpha";
  alpha.alpha_mode = AlphaMode::blend;
  EXPECT_TRUE(part(alpha)[4]);
  alpha.alpha = 1;
  EXPECT_FALSE(part(alpha)[4]) << "nothing to test";
  EXPECT_TRUE(part(alpha, true)[4]) << "vertex colours may be transparent";
  alpha.base_color_texture = texture;
  alpha.alpha_mode = AlphaMode::mask;
  EXPECT_TRUE(part(alpha)[4]);
}

TEST(World, TakesBoundsFromAWorldOfTheSameMeshes) {
  Scene scene = make_scene();
  add_root(scene, mesh_node());
  const World first = make_world(scene);
  scene.nodes[0].transform = translate({5, 0, 0});
  const World moved = make_world(scene, &first);
  EXPECT_EQ(moved.parts[0].bounds, first.parts[0].bounds);
  expect_near(moved.bounds.min, {5, 0, 0});
}

// --- Lights ---

// EXT_lights_area: the size grows with the largest component of the node's scale, uniformly. It emits along
// -z.
TEST(World, ScalesAreaLightsByTheLargestComponent) {
  Scene scene;
  Light light;
  light.kind = LightKind::rectangle;
  light.width = 2;
  light.height = 6;
  light.color = {1, 0.5f, 0};
  light.intensity = 10;
  Transform t = scale({0.5f, 3, 1});
  t.translation = {1, 2, 3};
  add_light(scene, light, t);
  light.kind = LightKind::disk;
  add_light(scene, light, scale({4, 1, 1}));
  const World world = make_world(scene);
  const AreaLight &rectangle = world.area_lights.at(0), &disk = world.area_lights.at(1);
  expect_near(rectangle.half_x, {3, 0, 0});
  expect_near(rectangle.half_y, {0, 9, 0});
  expect_near(rectangle.normal, {0, 0, -1});
  expect_near(rectangle.center, {1, 2, 3});
  expect_near(rectangle.radiance, {10, 5, 0});
  EXPECT_FALSE(rectangle.disk);
  EXPECT_TRUE(disk.disk);
  expect_near(disk.half_x, {4, 0, 0});
  expect_near(disk.half_y, {0, 4, 0});
  expect_near(world.bounds.max, {4, 11, 3});
}

TEST(World, AMirroredAreaLightShinesTheOtherWay) {
  Scene scene;
  Light light;
  light.kind = LightKind::rectangle;
  add_light(scene, light, scale({1, 1, -1}));
  add_light(scene, light, scale({-1, 1, 1}));
  const World world = make_world(scene);
  expect_near(world.area_lights.at(0).normal, {0, 0, 1});
  expect_near(world.area_lights.at(1).normal, {0, 0, -1});
}

// A turned, sheared node keeps the sides of its light square.
TEST(World, AreaLightsStayRectangles) {
  Scene scene;
  Light light;
  light.kind = LightKind::rectangle;
  Transform t;
  t.matrix = Imath::M44f(1, 0.5f, 0, 0, 0.3f, 2, 1, 0, 0.2f, 0, 1, 0, 0, 0, 0, 1);
  add_light(scene, light, t);
  const AreaLight area = make_world(scene).area_lights.at(0);
  EXPECT_NEAR(area.half_x.dot(area.half_y), 0, 1e-6);
  EXPECT_NEAR(area.half_x.dot(area.normal), 0, 1e-6);
  EXPECT_NEAR(area.normal.length(), 1, 1e-6);
  EXPECT_NEAR(area.half_x.length(), area.half_y.length(), 1e-6);
  expect_near(area.normal, -normalize(Vec3f(0.2f, 0, 1)));
}

TEST(World, PlacesPunctualLightsAlongMinusZ) {
  Scene scene;
  Light light;
  light.kind = LightKind::spot;
  light.color = {0.5f, 1, 0};
  light.intensity = 8;
  light.range = 3;
  light.inner_angle = 0.2f;
  light.outer_angle = 0.6f;
  Transform t = turn({0, 1, 0}, kPi / 2);
  t.translation = {1, 2, 3};
  t.scale = {5, 5, 5};
  add_light(scene, light, t);
  const PunctualLight spot = make_world(scene).punctual_lights.at(0);
  expect_near(spot.position, {1, 2, 3});
  expect_near(spot.direction, {-1, 0, 0});
  expect_near(spot.intensity, {4, 8, 0});
  EXPECT_EQ(spot.range, 3);
  EXPECT_FLOAT_EQ(spot.cos_inner, std::cos(0.2f));
  EXPECT_FLOAT_EQ(spot.cos_outer, std::cos(0.6f));
  EXPECT_TRUE(make_world(scene).bounds.isEmpty()) << "a point has no extent";
}

// --- Cameras ---

TEST(World, CamerasIgnoreTheScaleOfTheirNodes) {
  Scene scene;
  Transform t = turn({0, 1, 0}, kPi / 2);
  t.scale = {2, 7, 0.5f};
  t.translation = {1, 2, 3};
  const int node = add_camera(scene, {}, t);
  for (const std::vector<CameraPlacement>& cameras : {place_cameras(scene), make_world(scene).cameras}) {
    ASSERT_EQ(cameras.size(), 1u);
    EXPECT_EQ(cameras[0].node, node);
    expect_near(cameras[0].to_world.x, {0, 0, -1});
    expect_near(cameras[0].to_world.y, {0, 1, 0});
    expect_near(cameras[0].to_world.z, {1, 0, 0});
    expect_near(cameras[0].to_world.origin, {1, 2, 3});
  }
}

/// How far a point is from the middle of the image, 1 being the border.
float image_offset(const CameraView& view, const Vec3f& p) {
  const Affine& m = view.to_world;
  const Vec3f d = p - m.origin;
  const float depth = -d.dot(m.z);
  EXPECT_GT(depth, 0);
  // The corner of the image, on the plane at distance 1.
  return std::max(std::abs(d.dot(m.x)) / (depth * std::abs(view.corner.dot(m.x))),
                  std::abs(d.dot(m.y)) / (depth * std::abs(view.corner.dot(m.y))));
}

// Whatever its size and place, the scene is in the picture and fills a good part of it.
TEST(AddMissing, TheCameraFramesTheScene) {
  for (const Vec3f& size :
       {Vec3f(1, 1, 1), Vec3f(100, 1, 1), Vec3f(1e-4f, 3e-4f, 1e-4f), Vec3f(1e5f, 1, 1e5f)}) {
    Scene scene;
    const Vec3f center = size * 10;
    add_mesh(scene, make_box(center - size, center + size), add_material(scene, make_lambert({1, 1, 1})));
    EXPECT_EQ(add_missing_camera_and_light(scene).size(), 2u);
    ASSERT_EQ(place_cameras(scene).size(), 1u);
    for (const auto& [width, height] : {std::pair(160, 90), {100, 100}}) {
      const CameraView view = make_camera_view(scene, place_cameras(scene)[0], width, height);
      float most = 0;
      for (int corner = 0; corner < 8; ++corner)
        most =
            std::max(most, image_offset(view, center + size * Vec3f(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1,
                                                                    corner & 4 ? 1 : -1)));
      EXPECT_LE(most, 1) << size.x << " in " << width << " x " << height;
      EXPECT_GT(most, 0.3) << size.x << " in " << width << " x " << height;
    }
  }
}

TEST(AddMissing, AnEmptySceneGetsACameraToo) {
  Scene scene;
  EXPECT_EQ(add_missing_camera_and_light(scene).size(), 2u);
  const std::vector<CameraPlacement> cameras = place_cameras(scene);
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_TRUE(is_finite(cameras[0].to_world.origin) && is_finite(cameras[0].to_world.x));
  EXPECT_EQ(scene.environment.radiance, Rgb(1, 1, 1));
}

// Each kind of light keeps the sky away; a light that hangs on no root does not.
TEST(AddMissing, TheSkyIsForScenesWithoutLight) {
  const auto sky_is_added = [](Scene scene) {
    add_camera(scene, {});
    const std::vector<std::string> notes = add_missing_camera_and_light(scene);
    EXPECT_EQ(scene.cameras.size(), 1u) << "it had a camera";
    const bool added = !is_black(scene.environment.radiance);
    EXPECT_EQ(notes.size(), added ? 1u : 0u);
    if (added) {
      EXPECT_NE(notes.at(0).find("sky"), std::string::npos);
    }
    return added;
  };
  Scene dark = make_scene();
  add_root(dark, mesh_node());
  EXPECT_TRUE(sky_is_added(dark));
  for (const LightKind kind :
       {LightKind::point, LightKind::spot, LightKind::directional, LightKind::rectangle, LightKind::disk}) {
    Scene scene = dark;
    Light light;
    light.kind = kind;
    add_light(scene, light);
    EXPECT_FALSE(sky_is_added(scene));
    scene.roots.pop_back();
    EXPECT_TRUE(sky_is_added(scene)) << "its node is not shown";
  }
  Scene emissive = dark;
  emissive.materials[0].emission = {1, 1, 1};
  EXPECT_FALSE(sky_is_added(emissive));
  emissive.roots.clear();
  EXPECT_TRUE(sky_is_added(emissive));
  Scene unlit = dark;
  unlit.materials[0].unlit = true;
  EXPECT_FALSE(sky_is_added(unlit)) << "what is unlit is seen without a light";
}

TEST(AddMissing, AnEnvironmentIsALight) {
  Scene scene = make_scene();
  scene.environment.radiance = {0.1f, 0.2f, 0.3f};
  EXPECT_EQ(add_missing_camera_and_light(scene).size(), 1u);
  EXPECT_EQ(scene.environment.radiance, Rgb(0.1f, 0.2f, 0.3f));
}

}  // namespace
}  // namespace parian
