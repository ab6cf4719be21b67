// What commands do to the tree: indices, order, and where things are seen.
#include "editing/nodes.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "editing/add.h"
#include "editing/materials.h"
#include "editing/textures.h"
#include "editing/tree.h"
#include "renderer/base/error.h"
#include "tests/editing/support/random_commands.h"

namespace parian {
namespace {

Transform turned(const Vec3f& translation, const Quatf& rotation, const Vec3f& scale) {
  Transform t;
  t.translation = translation;
  t.rotation = rotation.normalized();
  t.scale = scale;
  return t;
}

/// a { b { c, d }, e }, f; all turned and moved, scales alike along the axes but for d's.
Scene family() {
  Scene scene;
  const auto add = [&](const char* name, int parent, const Transform& t) {
    return edit::add_group(scene, name, {parent, t});
  };
  const int a = add("a", kNone, turned({1, 2, 3}, {1, 2, 0, 1}, Vec3f(2)));
  const int b = add("b", a, turned({0, -1, 2}, {3, 0, 1, -1}, Vec3f(0.5f)));
  add("c", b, turned({5, 0, 0}, {1, 1, 1, 0}, Vec3f(3)));
  add("d", b, turned({0, 1, 0}, {0, 1, 0, 1}, {1, 2, -3}));
  add("e", a, turned({1, 1, 1}, {2, 0, 0, -1}, Vec3f(1)));
  add("f", kNone, turned({-4, 0, 1}, {1, -1, 2, 0}, Vec3f(1.5f)));
  return scene;
}

/// Where each node is seen, by name.
std::map<std::string, Mat4d> places(const Scene& scene) {
  std::map<std::string, Mat4d> found;
  const std::vector<int> parents = edit::find_parents(scene);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    found[scene.nodes[i].name] = edit::find_to_world(scene, int(i), parents);
  return found;
}

/// All that both have are at the same places.
void expect_same_places(const Scene& a, const Scene& b) {
  const auto before = places(a), after = places(b);
  for (const auto& [name, matrix] : after) {
    if (!before.contains(name)) continue;
    EXPECT_TRUE(matrix.equalWithAbsError(before.at(name), 2e-5)) << name;
  }
}

/// The tree as text: "a(b(c d) e) f".
std::string shown(const Scene& scene, const std::vector<int>& nodes) {
  std::string text;
  for (const int node : nodes) {
    if (!text.empty()) text += ' ';
    const Node& n = scene.nodes[std::size_t(node)];
    text += n.name;
    if (!n.children.empty()) text += '(' + shown(scene, n.children) + ')';
  }
  return text;
}
std::string shown(const Scene& scene) { return shown(scene, scene.roots); }

// Caught: matrices multiplied the wrong way round.
TEST(Nodes, ReparentingKeepsThePlace) {
  const Scene before = family();
  Scene scene = before;
  edit::reparent(scene, 1, 5);
  EXPECT_EQ(shown(scene), "a(e) f(b(c d))");
  expect_same_places(before, scene);
  edit::reparent(scene, 2, kNone, 0);
  EXPECT_EQ(shown(scene), "c a(e) f(b(d))");
  expect_same_places(before, scene);
  // Below a scale that is not the same along all axes it would be turned only by shear.
  edit::reparent(scene, 5, 4);
  edit::reparent(scene, 2, 3);
  EXPECT_TRUE(scene.nodes[2].transform.matrix);
  expect_same_places(before, scene);
  EXPECT_NO_THROW(validate(scene, "edited"));
}

TEST(Nodes, ReparentingWithoutKeepsTheTransform) {
  Scene scene = family();
  const Transform transform = scene.nodes[1].transform;
  edit::reparent(scene, 1, 5, 0, false);
  EXPECT_EQ(scene.nodes[1].transform, transform);
  EXPECT_EQ(shown(scene), "a(e) f(b(c d))");
}

TEST(Nodes, ReorderingIsAmongSiblings) {
  Scene scene = family();
  edit::reorder(scene, 3, 0);
  edit::reorder(scene, 0, 1);
  EXPECT_EQ(shown(scene), "f a(b(d c) e)");
}

TEST(Nodes, GroupsAndUngroupsInPlace) {
  const Scene before = family();
  Scene scene = before;
  EXPECT_EQ(edit::group(scene, std::vector<int>{4, 2, 5}, "g"), 6);
  EXPECT_EQ(shown(scene), "a(b(d) g(e c f))");
  expect_same_places(before, scene);
  edit::set_transform(scene, 6, {Vec3f(1, 0, 0), Quatf(0.6f, 0, 0.8f, 0), {}});
  const Scene moved = scene;
  const std::vector<int> renumbered = edit::ungroup(scene, 6);
  EXPECT_EQ(renumbered, (std::vector<int>{0, 1, 2, 3, 4, 5, kNone}));
  EXPECT_EQ(shown(scene), "a(b(d) e c f)");
  expect_same_places(moved, scene);
}

TEST(Nodes, AHiddenGroupLeavesHiddenNodes) {
  Scene scene = family();
  edit::set_visible(scene, 1, false);
  edit::ungroup(scene, 1);
  EXPECT_EQ(shown(scene), "a(c d e) f");
  EXPECT_FALSE(scene.nodes[1].visible);
  EXPECT_FALSE(scene.nodes[2].visible);
  EXPECT_TRUE(scene.nodes[3].visible);
}

TEST(Nodes, RemovingRenumbersTheOthers) {
  const Scene before = family();
  Scene scene = before;
  EXPECT_EQ(edit::remove(scene, 1), (std::vector<int>{0, kNone, kNone, kNone, 1, 2}));
  EXPECT_EQ(shown(scene), "a(e) f");
  expect_same_places(before, scene);
  scene = before;
  edit::remove(scene, 1, edit::Removal::node_alone);
  EXPECT_EQ(shown(scene), "a(c d e) f");
  expect_same_places(before, scene);
  edit::remove(scene, 0, edit::Removal::node_alone);
  EXPECT_EQ(shown(scene), "c d e f");
  expect_same_places(before, scene);
}

TEST(Nodes, DuplicatesShareWhatTheyShow) {
  Scene scene = family();
  edit::add_shape(scene, edit::sphere(1), {3, {}});
  edit::add_light(scene, edit::default_light(LightKind::spot), {2, {}});
  EXPECT_EQ(edit::duplicate(scene, 1), 8);
  EXPECT_EQ(shown(scene), "a(b(c(spot light) d(sphere)) b(c(spot light) d(sphere)) e) f");
  EXPECT_EQ(scene.shapes.size(), 1u);
  EXPECT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.nodes.size(), 13u);
  EXPECT_NO_THROW(validate(scene, "edited"));
}

TEST(Nodes, MatricesBecomeTranslationRotationScale) {
  for (const Vec3f& scale : {Vec3f(1), Vec3f(2, 3, 0.001f), Vec3f(1, -2, 3), Vec3f(-1, -1, -1)})
    for (const Quatf& rotation : {Quatf(1, 0, 0, 0), Quatf(0, 1, 0, 0), Quatf(0, 0, 1, 0), Quatf(0, 0, 0, 1),
                                  Quatf(1, 2, -3, 0.5f), Quatf(-0.1f, 1, 0.3f, 0)}) {
      const Mat4d matrix = turned({1, -2, 1e4f}, rotation, scale).to_matrix();
      const Transform t = edit::to_transform(matrix);
      ASSERT_FALSE(t.matrix);
      EXPECT_TRUE(t.to_matrix().equalWithAbsError(matrix, 3e-6));
    }
}

TEST(Nodes, OfAShearedMatrixTheTranslationIsSet) {
  Scene scene = family();
  Mat4d sheared;
  sheared[0][1] = 0.5;
  edit::set_matrix(scene, 0, sheared);
  ASSERT_TRUE(scene.nodes[0].transform.matrix);
  EXPECT_THROW(edit::set_transform(scene, 0, {{}, {}, Vec3f(2)}), UsageError);
  edit::set_transform(scene, 0, {Vec3f(7, 8, 9), {}, {}});
  sheared[3][0] = 7, sheared[3][1] = 8, sheared[3][2] = 9;
  EXPECT_EQ(scene.nodes[0].transform.to_matrix(), sheared);
  edit::set_transform(scene, 0, {{}, Quatf(0, 1, 0, 0), Vec3f(2)});
  EXPECT_EQ(scene.nodes[0].transform, turned({7, 8, 9}, {0, 1, 0, 0}, Vec3f(2)));
}

TEST(Nodes, OfATurnedMatrixTheRestStays) {
  Scene scene = family();
  const Transform t = turned({1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4});
  scene.nodes[0].transform = {};
  scene.nodes[0].transform.matrix = Imath::M44f(t.to_matrix());
  edit::set_transform(scene, 0, {{}, {}, Vec3f(1)});
  EXPECT_FALSE(scene.nodes[0].transform.matrix);
  EXPECT_TRUE(scene.nodes[0].transform.to_matrix().equalWithAbsError(
      turned({1, 2, 3}, {1, 2, 3, 4}, Vec3f(1)).to_matrix(), 1e-6));
}

TEST(Nodes, ACameraSeesFromWhereItWasTold) {
  for (const Vec3f& up : {Vec3f(0, 1, 0), Vec3f(1, 0, 0), Vec3f(0, 0, 5), Vec3f(0)}) {
    Scene scene;
    edit::add_camera_from_view(scene, {}, {1, 2, 3}, {1, 2, -5}, up);
    const Affine m = to_affine(scene.nodes[0].transform.to_matrix());
    EXPECT_TRUE((-m.z).equalWithAbsError({0, 0, -1}, 1e-6f));
    EXPECT_TRUE(m.origin.equalWithAbsError({1, 2, 3}, 1e-6f));
    EXPECT_GE(m.y.dot(up), 0);
    EXPECT_NEAR(m.determinant(), 1, 1e-5f);
  }
}

TEST(Unused, IsRemovedWithWhatOnlyItUsed) {
  Scene scene = family();
  edit::add_shape(scene, edit::sphere(1));
  const int gone = edit::add_shape(scene, edit::box(Vec3f(1)));
  edit::add_shape(scene, edit::cone(1, 1));
  edit::assign_texture(scene, 1, "base_color", small_image(1));
  edit::assign_texture(scene, 2, "base_color", small_image(2));
  EXPECT_EQ(edit::remove_unused(scene), 0u);
  edit::remove(scene, gone);
  EXPECT_EQ(scene.shapes.size(), 3u);
  EXPECT_EQ(edit::remove_unused(scene), 4u);  // shape, material, texture, image
  EXPECT_NO_THROW(validate(scene, "edited"));
  EXPECT_EQ(scene.shapes[std::size_t(scene.nodes.back().shape)].name, "cone");
  const Material& left = scene.materials[std::size_t(scene.nodes.back().shape_material)];
  EXPECT_EQ(left.name, "cone");
  const Texture& texture = scene.textures[std::size_t(left.base_color_texture.texture)];
  EXPECT_EQ(scene.images[std::size_t(texture.image)], small_image(2));
}

TEST(Materials, ASingleUserSharesVertices) {
  Scene scene;
  parian::add_mesh(scene, make_box(Vec3f(0), Vec3f(1)), parian::add_material(scene, {}));
  add_root(scene, scene.nodes[0]);
  EXPECT_EQ(edit::make_single_user(scene, {1, 0}), 1);
  EXPECT_EQ(edit::material_of(scene, {0, 0}), 0);
  EXPECT_EQ(edit::material_of(scene, {1, 0}), 1);
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.meshes[0].primitives[0].positions.data(), scene.meshes[1].primitives[0].positions.data());
  EXPECT_EQ(edit::make_single_user(scene, {1, 0}), 1);  // it is one
  EXPECT_EQ(scene.meshes.size(), 2u);
}

TEST(Textures, OneImageOfManyUses) {
  Scene scene;
  parian::add_material(scene, {});
  parian::add_material(scene, {});
  for (const int material : {0, 1}) edit::assign_texture(scene, material, "emission", small_image(3));
  EXPECT_EQ(scene.images.size(), 1u);
  edit::set_sampling(scene, 0, "emission", {Wrap::clamp_to_edge, Wrap::mirrored_repeat, Filter::nearest});
  const auto texture = [&](int m) {
    return scene.textures[std::size_t(edit::texture_at(scene.materials[std::size_t(m)], "emission").texture)];
  };
  EXPECT_EQ(texture(0).wrap_s, Wrap::clamp_to_edge);
  EXPECT_EQ(texture(0).wrap_t, Wrap::mirrored_repeat);
  EXPECT_EQ(texture(0).filter, Filter::nearest);
  EXPECT_EQ(texture(1).filter, Filter::linear);
  // A new image of a slot keeps its sampling.
  edit::assign_texture(scene, 0, "emission", small_image(4));
  EXPECT_EQ(texture(0).filter, Filter::nearest);
}

// Where two materials share a texture, the sampling of one is not the other's.
TEST(Textures, SharedOnesPart) {
  Scene scene;
  parian::add_material(scene, {});
  edit::assign_texture(scene, 0, "base_color", small_image(3));
  edit::duplicate_material(scene, 0);
  edit::set_sampling(scene, 1, "base_color", {.filter = Filter::nearest});
  EXPECT_EQ(scene.textures[std::size_t(scene.materials[0].base_color_texture.texture)].filter,
            Filter::linear);
  EXPECT_EQ(scene.textures[std::size_t(scene.materials[1].base_color_texture.texture)].filter,
            Filter::nearest);
}

TEST(Textures, EverySlotHasAName) {
  Material m;
  m.transmission.emplace(), m.diffuse_transmission.emplace(), m.clearcoat.emplace();
  m.sheen.emplace(), m.anisotropy.emplace(), m.iridescence.emplace();
  std::set<const TextureRef*> all, named;
  for_each_texture(m, [&](TextureRef& t) { all.insert(&t); });
  for (const std::string_view slot : edit::texture_slots(m)) named.insert(&edit::texture_at(m, slot));
  EXPECT_EQ(named, all);
}

}  // namespace
}  // namespace parian
