// What commands refuse: with the reason, and the scene as it was.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "editing/scene_delta.h"
#include "renderer/base/error.h"
#include "tests/editing/support/random_commands.h"
#include "tests/renderer/session/support/session_scenes.h"

namespace parian {
namespace {

struct Refusal {
  const char* reason;  // a part of it
  std::function<void(Scene&)> run;
};

/// everything() with a group (12) of a node that has a flat scale (13).
Scene scene_with_flat_node() {
  Scene scene = everything();
  const int group = edit::add_group(scene, "group");
  Transform flat;
  flat.scale = {1, 0, 1};
  edit::add_group(scene, "flat", {group, flat});
  return scene;
}

void expect_refusals(const std::vector<Refusal>& refusals) {
  const Scene before = scene_with_flat_node();
  for (const Refusal& refusal : refusals) {
    Scene scene = before;
    try {
      refusal.run(scene);
      ADD_FAILURE() << "not refused: " << refusal.reason;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(refusal.reason), std::string::npos)
          << error.what() << "\n  instead of " << refusal.reason;
    }
    EXPECT_TRUE(scene == before) << refusal.reason;
  }
}

const float kNan = std::nanf("");

// Caught: a scale that nobody looks at.
TEST(Refusals, OfNodes) {
  using namespace edit;
  expect_refusals({
      {"node: expected an index below 14, not 14", [](Scene& s) { rename_node(s, 14, "x"); }},
      {"node: expected an index below 14, not -1", [](Scene& s) { set_visible(s, -1, false); }},
      {"translation: expected 3 finite numbers, in metres",
       [](Scene& s) {
         set_transform(s, 0, {Vec3f(0, kNan, 0), {}, {}});
       }},
      {"rotation: expected a unit quaternion",
       [](Scene& s) {
         set_transform(s, 0, {{}, Quatf(1, 1, 0, 0), {}});
       }},
      {"rotation: expected a unit quaternion",
       [](Scene& s) {
         set_transform(s, 0, {{}, Quatf(kNan, 0, 0, 0), {}});
       }},
      {"scale: expected 3 finite factors",
       [](Scene& s) {
         set_transform(s, 0, {{}, {}, Vec3f(1, 1, kInfinity)});
       }},
      {"expected an affine matrix",
       [](Scene& s) {
         Mat4d m;
         m[0][3] = 0.5;
         set_matrix(s, 0, m);
       }},
      {"expected finite numbers",
       [](Scene& s) {
         Mat4d m;
         m[3][0] = 1e300;
         set_matrix(s, 0, m);
       }},
      {"parent: expected an index below 14, not 99", [](Scene& s) { reparent(s, 0, 99); }},
      {"parent: expected a node outside the subtree", [](Scene& s) { reparent(s, 12, 13); }},
      {"parent: expected a node outside the subtree", [](Scene& s) { reparent(s, 12, 12); }},
      {"position: expected a number from 0 to 1, not 2", [](Scene& s) { reparent(s, 1, 12, 2); }},
      // Among the others: the node that is moved is not counted.
      {"position: expected a number from 0 to 12, not 13", [](Scene& s) { reparent(s, 0, kNone, 13); }},
      {"parent: expected a scale other than 0", [](Scene& s) { reparent(s, 1, 13); }},
      {"position: expected a number from 0 to 12, not 13", [](Scene& s) { reorder(s, 0, 13); }},
      {"group: expected one node at least", [](Scene& s) { group(s, std::vector<int>{}, "x"); }},
      {"group: expected each node once",
       [](Scene& s) {
         group(s, std::vector<int>{1, 2, 1}, "x");
       }},
      {"13 is below 12",
       [](Scene& s) {
         group(s, std::vector<int>{12, 13}, "x");
       }},
      {"group: expected a node without mesh", [](Scene& s) { ungroup(s, 0); }},
      {"node: expected an index", [](Scene& s) { duplicate(s, 14); }},
      {"node: expected an index", [](Scene& s) { edit::remove(s, 14); }},
  });
}

TEST(Refusals, OfNewElements) {
  using namespace edit;
  expect_refusals({
      {"radius: expected a number above 0, not 0", [](Scene& s) { add_shape(s, sphere(0)); }},
      {"radius: expected a number above 0, not nan", [](Scene& s) { add_shape(s, sphere(kNan)); }},
      {"size: expected a number above 0, not -1",
       [](Scene& s) {
         add_shape(s, box({1, -1, 1}));
       }},
      {"radius_top: expected a number above 0", [](Scene& s) { add_shape(s, frustum(0, 0, 1)); }},
      {"material: expected an index below 5, not 5", [](Scene& s) { add_shape(s, sphere(1), {}, 5); }},
      {"parent: expected an index",
       [](Scene& s) {
         add_shape(s, sphere(1), {14, {}});
       }},
      {"translation: expected finite numbers",
       [](Scene& s) {
         edit::add_light(s, {}, {kNone, translate({kNan, 0, 0})});
       }},
      {"intensity: expected a number of at least 0, not -1",
       [](Scene& s) {
         Light light;
         light.intensity = -1;
         edit::add_light(s, light);
       }},
      {"yfov: expected a number",
       [](Scene& s) {
         Camera camera;
         camera.yfov = 4;
         edit::add_camera(s, camera);
       }},
      {"finite and apart",
       [](Scene& s) {
         add_camera_from_view(s, {}, {1, 1, 1}, {1, 1, 1});
       }},
      {"parent: expected an index",
       [](Scene& s) {
         add_scene(s, everything(), "x", {77, {}});
       }},
      {"expected a size of at least 1 x 1", [](Scene& s) { set_environment_image(s, Image{}); }},
      {"environment: expected one with an image", [](Scene& s) { remove_environment_image(s); }},
  });
}

TEST(Refusals, OfMaterials) {
  using namespace edit;
  expect_refusals({
      {"material: expected an index below 5, not 5",
       [](Scene& s) {
         assign_material(s, {1, 0}, 5);
       }},
      {"node: expected one that shows a shape", [](Scene& s) { assign_material(s, {1}, 0); }},
      {"node: expected one that shows a mesh",
       [](Scene& s) {
         assign_material(s, {8, 0}, 0);
       }},
      {"primitive: expected an index below 1, not 1",
       [](Scene& s) {
         make_single_user(s, {1, 1});
       }},
      {"replacement: expected another", [](Scene& s) { remove_material(s, 1, 1); }},
      {"replacement: expected an index", [](Scene& s) { remove_material(s, 1, -1); }},
      {"roughness: expected a number in [0, 1], not 2",
       [](Scene& s) {
         Material m;
         m.roughness = 2;
         edit::add_material(s, m);
       }},
      {"texture: expected an index below 1, not 5",
       [](Scene& s) {
         Material m;
         m.base_color_texture.texture = 5;
         edit::add_material(s, m);
       }},
      {"texture: expected one of base_color, ",
       [](Scene& s) { assign_texture(s, 1, "clearcoat", small_image(0)); }},
      {"texture: expected one of base_color, ", [](Scene& s) { assign_texture(s, 1, "nose", "none.png"); }},
      {"expected a slot that has one, which normal has not",
       [](Scene& s) { remove_texture(s, 0, "normal"); }},
      {"UV set: expected 0 or 1, not 2", [](Scene& s) { set_uv_set(s, 0, "base_color", 2); }},
  });
}

TEST(Refusals, AFileThatIsNotThereLeavesTheScene) {
  const Scene before = everything();
  Scene scene = before;
  EXPECT_THROW(edit::assign_texture(scene, 1, "base_color", "/no/such/file.png"), InputError);
  EXPECT_THROW(edit::set_environment_image(scene, "/no/such/file.exr"), InputError);
  EXPECT_TRUE(scene == before);
}

// Of several commands in one edit.
TEST(Refusals, ARecordedEditIsDoneWholeOrNotAtAll) {
  const Scene before = everything();
  Scene scene = before;
  EXPECT_THROW(record(scene,
                      [](Scene& s) {
                        edit::rename_node(s, 0, "done");
                        edit::rename_node(s, 99, "refused");
                      }),
               UsageError);
  EXPECT_TRUE(scene == before);
}

}  // namespace
}  // namespace parian
