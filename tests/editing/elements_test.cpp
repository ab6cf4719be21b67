// Where copies of nodes stand, which element of a scene a command means, and what surrounds the scene.
#include <gtest/gtest.h>

#include <vector>

#include "editing/environment.h"
#include "editing/materials.h"
#include "editing/nodes.h"
#include "tests/editing/support/random_commands.h"

namespace parian {
namespace {

// Caught: copies before their originals, and behind all siblings.
TEST(Duplicates, StandBehindTheirOriginals) {
  Scene scene;
  scene.nodes.resize(5);
  scene.nodes[3].children = {4, 1, 2};
  scene.roots = {0, 3};
  EXPECT_EQ(edit::duplicate(scene, 1), 5);
  EXPECT_EQ(scene.nodes[3].children, (std::vector<int>{4, 1, 5, 2}));
  EXPECT_EQ(edit::duplicate(scene, 0), 6);
  EXPECT_EQ(scene.roots, (std::vector<int>{0, 6, 3}));
}

// Caught: the first primitive's in place of that which was named.
TEST(AssignedMaterials, AreThoseOfOnePrimitiveOrShape) {
  Scene scene;
  for (int i = 0; i < 3; ++i) add_material(scene, {});
  add_mesh(scene, make_box(Vec3f(0), Vec3f(1)), 0);
  scene.meshes[0].primitives.push_back(make_box(Vec3f(2), Vec3f(3)));
  scene.meshes[0].primitives[1].material = 0;
  add_shape(scene, make_sphere(1), 0);
  edit::assign_material(scene, {0, 1}, 2);
  edit::assign_material(scene, {1, kNone}, 1);
  EXPECT_EQ(scene.meshes[0].primitives[0].material, 0);
  EXPECT_EQ(scene.meshes[0].primitives[1].material, 2);
  EXPECT_EQ(scene.nodes[1].shape_material, 1);
  EXPECT_EQ(edit::material_of(scene, {0, 0}), 0);
  EXPECT_EQ(edit::material_of(scene, {0, 1}), 2);
  EXPECT_EQ(edit::material_of(scene, {1, kNone}), 1);
}

// Caught: an image of another number; a black environment that stays black; an image that is not let go.
TEST(EnvironmentImage, IsSetSharedAndRemoved) {
  Scene scene;
  scene.images = {small_image(1), small_image(2)};
  scene.environment.radiance = Rgb(0);
  edit::set_environment_image(scene, small_image(2));
  EXPECT_EQ(scene.environment.image, 1);
  EXPECT_EQ(scene.images.size(), 2u) << "it is there already";
  EXPECT_EQ(scene.environment.radiance, Rgb(1)) << "black would hide it";
  scene.environment.radiance = {0, 0.5f, 0};
  edit::set_environment_image(scene, small_image(3));
  EXPECT_EQ(scene.environment.image, 2);
  EXPECT_EQ(scene.images.at(2), small_image(3));
  EXPECT_EQ(scene.environment.radiance, Rgb(0, 0.5f, 0)) << "of the user's own choice";
  edit::remove_environment_image(scene);
  EXPECT_EQ(scene.environment.image, kNone);
  EXPECT_EQ(scene.environment.radiance, Rgb(0, 0.5f, 0));
}

// Caught: an image that nothing but the environment has, taken for one that nothing has.
TEST(EnvironmentImage, IsUsed) {
  Scene scene;
  scene.images = {small_image(1), small_image(2)};
  scene.environment.image = 1;
  EXPECT_EQ(edit::remove_unused(scene), 1u);
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.environment.image, 0);
  EXPECT_EQ(scene.images[0], small_image(2));
}

// Caught: the texture of another material changed, since both have the same.
TEST(AssignedTextures, AreOfOneMaterial) {
  Scene scene;
  add_material(scene, {});
  edit::assign_texture(scene, 0, "emission", small_image(1));
  edit::duplicate_material(scene, 0);
  edit::assign_texture(scene, 1, "emission", small_image(2));
  const auto image = [&](std::size_t material) {
    const int texture = scene.materials[material].emission_texture.texture;
    return scene.images.at(std::size_t(scene.textures.at(std::size_t(texture)).image));
  };
  EXPECT_EQ(image(0), small_image(1));
  EXPECT_EQ(image(1), small_image(2));
}

}  // namespace
}  // namespace parian
