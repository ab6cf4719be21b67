#include "renderer/scene/scene.h"

#include <gtest/gtest.h>

#include <random>

namespace parian {
namespace {

TEST(Transform, IsScaleThenRotationThenTranslation) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-2, 2);
  for (int i = 0; i < 100; ++i) {
    Transform t;
    t.translation = Vec3f(float(uniform(random)), float(uniform(random)), float(uniform(random)));
    t.scale = Vec3f(float(uniform(random)), float(uniform(random)), float(uniform(random)));
    t.rotation =
        Quatf(float(uniform(random)), float(uniform(random)), float(uniform(random)), float(uniform(random)))
            .normalized();
    const Vec3f p(float(uniform(random)), float(uniform(random)), float(uniform(random)));
    const Vec3d expected(t.rotation.rotateVector(p * t.scale) + t.translation);
    EXPECT_LT((Vec3d(p) * t.to_matrix() - expected).length(), 1e-5);
  }
}

TEST(Transform, IsItsMatrixWhereThereIsOne) {
  Transform t;
  t.scale = Vec3f(9);
  t.matrix = Imath::M44f(1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 10, 11, 12, 1);
  EXPECT_EQ(t.to_matrix(), Mat4d(*t.matrix));
}

// A turn of a scene by a quarter must not shrink it in the tenth digit, which float would.
TEST(Transform, IsExactToDouble) {
  Transform t;
  t.rotation = Quatf(1, 0, 1, 0);  // not unit on purpose: only its direction counts
  const Mat4d m = t.to_matrix();
  EXPECT_NEAR(m[0][2], -1, 1e-15);
  EXPECT_NEAR(m[2][0], 1, 1e-15);
  EXPECT_NEAR(m[0][0], 0, 1e-15);
}

Scene small_scene(const std::string& name) {
  Scene scene;
  scene.images = {{.name = name,
                   .width = 1,
                   .height = 1,
                   .channels = 1,
                   .type = PixelType::u8,
                   .pixels = std::vector<std::byte>(1)}};
  scene.textures.emplace_back().image = 0;
  Material& material = scene.materials.emplace_back();
  material.name = name;
  material.transmission.emplace();
  material.diffuse_transmission.emplace();
  material.clearcoat.emplace();
  material.sheen.emplace();
  material.anisotropy.emplace();
  material.iridescence.emplace();
  for_each_texture(material, [](TextureRef& ref) { ref.texture = 0; });
  scene.materials.emplace_back().name = "plain";
  Primitive primitive;
  primitive.positions = std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  primitive.triangles = std::vector<Triangle>{{0, 1, 2}};
  primitive.material = 0;
  scene.meshes = {{.name = name, .primitives = {primitive}}};
  scene.shapes.emplace_back().name = name;
  scene.cameras.emplace_back().name = name;
  scene.lights.emplace_back().name = name;
  scene.nodes.resize(2);
  scene.nodes[0].children = {1};
  scene.nodes[1].mesh = scene.nodes[1].camera = scene.nodes[1].light = 0;
  scene.nodes[1].shape = 0;
  scene.nodes[1].shape_material = 1;
  scene.roots = {0};
  scene.environment.image = 0;
  return scene;
}

TEST(Append, ShiftsEveryIndex) {
  Scene scene = small_scene("a");
  append(scene, small_scene("b"));
  ASSERT_EQ(scene.nodes.size(), 4u);
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 2}));
  EXPECT_EQ(scene.nodes[2].children, std::vector<int>{3});
  EXPECT_EQ(scene.nodes[2].mesh, kNone);
  EXPECT_EQ(scene.meshes.at(std::size_t(scene.nodes[3].mesh)).name, "b");
  EXPECT_EQ(scene.nodes[2].shape, kNone);
  EXPECT_EQ(scene.shapes.at(std::size_t(scene.nodes[3].shape)).name, "b");
  EXPECT_EQ(scene.nodes[3].shape_material, 3);
  EXPECT_EQ(scene.cameras.at(std::size_t(scene.nodes[3].camera)).name, "b");
  EXPECT_EQ(scene.lights.at(std::size_t(scene.nodes[3].light)).name, "b");
  const Material& material = scene.materials.at(std::size_t(scene.meshes[1].primitives[0].material));
  EXPECT_EQ(material.name, "b");
  int uses = 0;
  for_each_texture(material, [&](const TextureRef& ref) {
    EXPECT_EQ(scene.images.at(std::size_t(scene.textures.at(std::size_t(ref.texture)).image)).name, "b");
    ++uses;
  });
  EXPECT_EQ(uses, 17);
  EXPECT_FALSE(scene.materials[3].base_color_texture);
  EXPECT_EQ(scene.nodes[1], small_scene("a").nodes[1]);
  validate(scene, "scene");
}

TEST(Append, ReplacesOnlyBlackEnvironments) {
  Scene scene = small_scene("a"), lit = small_scene("b"), other = small_scene("c");
  lit.environment.radiance = Rgb(1, 2, 3);
  other.environment.radiance = Rgb(4);
  append(scene, lit);
  EXPECT_EQ(scene.environment.radiance, Rgb(1, 2, 3));
  EXPECT_EQ(scene.images.at(std::size_t(scene.environment.image)).name, "b");
  append(scene, other);
  EXPECT_EQ(scene.environment.radiance, Rgb(1, 2, 3));
}

TEST(Append, TakesTheSceneItself) {
  Scene scene = small_scene("a"), expected = small_scene("a");
  append(expected, small_scene("a"));
  append(scene, scene);
  EXPECT_EQ(scene, expected);
}

TEST(Scene, ComparesContents) {
  const Scene a = small_scene("a");
  EXPECT_EQ(a, small_scene("a"));  // other arrays, same vertices
  Scene moved = a;
  moved.meshes[0].primitives[0].positions = std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  EXPECT_NE(a, moved);
}

}  // namespace
}  // namespace parian
