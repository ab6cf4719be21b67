// Each command: undone and done again, valid, and what a session is told of it.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <vector>

#include "editing/scene_delta.h"
#include "tests/editing/support/random_commands.h"
#include "tests/renderer/session/support/session_scenes.h"

namespace parian {
namespace {

constexpr unsigned kNothing = 0, kLamp = kChangedLights | kChangedTransforms;

struct Command {
  const char* name;
  std::function<void(Scene&)> run;
  unsigned changed;
};

void set(Scene& scene, const std::vector<edit::Property>& properties, int index, const char* name,
         const edit::PropertyValue& value) {
  edit::find_property(properties, name).set(scene, index, value);
}
void set_material(Scene& s, int index, const char* name, const edit::PropertyValue& value) {
  set(s, edit::material_properties(s.materials[std::size_t(index)]), index, name, value);
}

// Nodes of everything(): 0 floor, 1 and 2 boxes of one mesh, 3 pane, 4 lamp of triangles, 5 disk light, 6
// point light, 7 camera, 8 sphere that emits, 9 frustum, 10 box, 11 sphere.
std::vector<Command> node_commands() {
  using namespace edit;
  return {
      {"rename", [](Scene& s) { rename_node(s, 1, "box"); }, kNothing},
      {"move",
       [](Scene& s) {
         set_transform(s, 1, {Vec3f(0, 1, 0), {}, {}});
       },
       kChangedTransforms},
      {"turn",
       [](Scene& s) {
         set_transform(s, 9, {{}, Quatf(0.6f, 0.8f, 0, 0), {}});
       },
       kChangedTransforms},
      {"flatten",
       [](Scene& s) {
         set_transform(s, 1, {{}, {}, Vec3f(1, 0, 1)});
       },
       kChangedGeometry},
      {"move lamp",
       [](Scene& s) {
         set_transform(s, 5, {Vec3f(1, 2, 1), {}, {}});
       },
       kLamp},
      {"move camera",
       [](Scene& s) {
         set_transform(s, 7, {Vec3f(1, 1.4f, 4), {}, {}});
       },
       kChangedCamera},
      {"hide", [](Scene& s) { set_visible(s, 1, false); }, kChangedGeometry},
      {"hide lamp", [](Scene& s) { set_visible(s, 6, false); }, kLamp},
      // Drawn in the same order, and where it was.
      {"reparent in place", [](Scene& s) { reparent(s, 10, 9); }, kNothing},
      {"reparent elsewhere", [](Scene& s) { reparent(s, 10, 9, {}, false); }, kChangedTransforms},
      {"reparent camera", [](Scene& s) { reparent(s, 7, 1, {}, false); }, kChangedCamera},
      {"reorder", [](Scene& s) { reorder(s, 0, 3); }, kChangedGeometry},
      {"duplicate",
       [](Scene& s) {
         set_transform(s, duplicate(s, 8), {Vec3f(1, 1, 0), {}, {}});
       },
       kChangedGeometry},
      {"duplicate lamp",
       [](Scene& s) {
         set_transform(s, duplicate(s, 6), {Vec3f(-1, 2, 0), {}, {}});
       },
       kLamp},
      {"remove", [](Scene& s) { edit::remove(s, 3); }, kChangedGeometry | kLamp},
      {"remove lamp",
       // The spheres behind it get other numbers.
       [](Scene& s) { edit::remove(s, 5); }, kLamp | kChangedMaterials},
      // Both are drawn in the order in which they were.
      {"group",
       [](Scene& s) {
         group(s, std::vector<int>{10, 6}, "both");
       },
       kNothing},
      {"group in another order",
       [](Scene& s) {
         group(s, std::vector<int>{11, 8}, "both");
       },
       kChangedGeometry},
      {"add group", [](Scene& s) { add_group(s, "group"); }, kNothing},
  };
}

std::vector<Command> add_commands() {
  using namespace edit;
  const Transform at = translate({0, 1, 1});
  return {
      {"sphere",
       [=](Scene& s) {
         add_shape(s, sphere(0.3f), {kNone, at});
       },
       kChangedGeometry},
      {"box",
       [=](Scene& s) {
         add_shape(s, box(Vec3f(0.4f)), {1, at}, 3);
       },
       kChangedGeometry},
      {"cylinder",
       [=](Scene& s) {
         add_shape(s, cylinder(0.1f, 0.5f), {kNone, at});
       },
       kChangedGeometry},
      {"cone",
       [=](Scene& s) {
         add_shape(s, cone(0.3f, 0.5f), {kNone, at});
       },
       kChangedGeometry},
      {"frustum",
       [=](Scene& s) {
         add_shape(s, frustum(0.3f, 0.1f, 0.5f), {kNone, at});
       },
       kChangedGeometry},
      {"plane",
       [=](Scene& s) {
         add_shape(s, plane(1, 0.5f), {kNone, at});
       },
       kChangedGeometry},
      {"point light",
       [=](Scene& s) {
         edit::add_light(s, default_light(LightKind::point), {kNone, at});
       },
       kLamp},
      {"spot light",
       [=](Scene& s) {
         edit::add_light(s, default_light(LightKind::spot), {kNone, at});
       },
       kLamp},
      {"sun",
       [=](Scene& s) {
         edit::add_light(s, default_light(LightKind::directional), {kNone, at});
       },
       kLamp},
      {"rectangle",
       [=](Scene& s) {
         edit::add_light(s, default_light(LightKind::rectangle), {kNone, at});
       },
       kLamp},
      {"disk",
       [=](Scene& s) {
         edit::add_light(s, default_light(LightKind::disk), {kNone, at});
       },
       kLamp},
      {"camera",
       [](Scene& s) {
         add_camera_from_view(s, {}, {0, 2, 5}, {0, 0, 0});
       },
       kChangedCamera},
      {"scene",
       [](Scene& s) {
         Scene other;
         parian::add_mesh(other, make_box(Vec3f(-0.2f), Vec3f(0.2f)),
                          parian::add_material(other, make_lambert({1, 0, 0})));
         add_scene(s, other, "other", {kNone, translate({0, 0.8f, 1})});
       },
       kChangedGeometry},
      {"environment image", [](Scene& s) { set_environment_image(s, small_image(9)); }, kChangedLights},
  };
}

std::vector<Command> material_commands() {
  using namespace edit;
  return {
      {"assign to a mesh",
       [](Scene& s) {
         assign_material(s, {1, 0}, 0);
       },
       kChangedMaterials},
      {"assign to a solid", [](Scene& s) { assign_material(s, {9}, 3); }, kChangedMaterials},
      {"assign to a box", [](Scene& s) { assign_material(s, {10}, 2); }, kChangedMaterials},
      {"single user",
       [](Scene& s) { set_material(s, make_single_user(s, {10}), "base_color", Rgb(1, 0, 0)); },
       kChangedMaterials},
      {"single user of a shared mesh",
       [](Scene& s) {
         set_material(s, make_single_user(s, {1, 0}), "base_color", Rgb(1, 0, 0));
       },
       kChangedGeometry},
      {"add",
       [](Scene& s) {
         edit::add_material(s, make_lambert({1, 0, 0}));
       },
       kNothing},
      {"remove", [](Scene& s) { remove_material(s, 2, 0); }, kChangedMaterials | kChangedLights},
      {"rename", [](Scene& s) { rename_material(s, 1, "steel"); }, kNothing},
      {"colour", [](Scene& s) { set_material(s, 1, "base_color", Rgb(0, 1, 0)); }, kChangedMaterials},
      {"emission", [](Scene& s) { set_material(s, 1, "emission.strength", 2.0); },
       kChangedMaterials | kChangedLights},
      {"conductor", [](Scene& s) { set_material(s, 1, "type", std::string("conductor")); },
       kChangedMaterials},
      {"clear coat",
       [](Scene& s) { set_material(s, 3, "clearcoat", true), set_material(s, 3, "clearcoat.factor", 1.0); },
       kChangedMaterials},
      {"body", [](Scene& s) { set_material(s, 1, "type", std::string("subsurface")); }, kChangedMaterials},
      {"glass",
       [](Scene& s) {
         set_material(s, 1, "metallic", 0.0), set_material(s, 1, "roughness", 0.0);
         set_material(s, 1, "transmission", true), set_material(s, 1, "transmission.factor", 1.0);
         set_material(s, 1, "volume", true), set_material(s, 1, "volume.thickness", 1.0);
       },
       kChangedMaterials},
      {"texture", [](Scene& s) { assign_texture(s, 1, "base_color", small_image(1)); }, kChangedMaterials},
      {"no texture", [](Scene& s) { remove_texture(s, 0, "base_color"); }, kChangedMaterials},
      {"sampling", [](Scene& s) { set_sampling(s, 0, "base_color", {.filter = Filter::nearest}); },
       kChangedMaterials},
      {"radius", [](Scene& s) { set(s, shape_properties(s.shapes[0]), 0, "radius", 0.4); }, kChangedGeometry},
      {"intensity", [](Scene& s) { set(s, light_properties(s.lights[1]), 1, "intensity", 9.0); },
       kChangedLights},
      {"diameter", [](Scene& s) { set(s, light_properties(s.lights[0]), 0, "diameter", 2.0); },
       kChangedLights},
      {"kind of light",
       [](Scene& s) { set(s, light_properties(s.lights[0]), 0, "kind", std::string("rectangle")); },
       kChangedLights},
      {"pinhole", [](Scene& s) { set(s, camera_properties(s.cameras[0]), 0, "lens", false); },
       kChangedCamera},
      {"sky", [](Scene& s) { set(s, environment_properties(), 0, "radiance", 2.0); }, kChangedLights},
  };
}

std::vector<Command> all_commands() {
  std::vector<Command> all = node_commands();
  for (const auto& more : {add_commands(), material_commands()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

// Caught: elements behind a splice taken into it, lights or the material of a shape untold.
TEST(Commands, AreUndoneAndDoneAgain) {
  for (const Command& command : all_commands()) {
    const Scene before = everything();
    Scene scene = before;
    const SceneDelta delta = record(scene, command.run);
    const Scene after = scene;
    EXPECT_NO_THROW(validate(after, command.name));
    EXPECT_FALSE(after == before) << command.name;
    revert(scene, delta);
    EXPECT_TRUE(scene == before) << command.name;
    apply(scene, delta);
    EXPECT_TRUE(scene == after) << command.name;
    EXPECT_EQ(changed(delta), command.changed) << command.name;
    EXPECT_EQ(changed(make_delta(after, before)), command.changed) << command.name << ", back";
  }
}

// Caught: lights or the material of a shape untold.
TEST(Commands, AreFollowedByASession) {
  RenderSettings settings = small(2);
  settings.width = 26, settings.height = 19;
  for (const bool editable : {false, true}) {
    settings.accel.editable = editable;
    settings.build = BuildQuality::balanced;
    Session session = make_session(everything(), settings);
    const Picture original = finish(session);
    for (const Command& command : all_commands()) {
      Scene scene = everything();
      // Made once: the session holds on to arrays, which another everything() has elsewhere.
      const auto before = std::make_shared<const Scene>(scene);
      session.update(before, ~0u);
      const SceneDelta delta = record(scene, command.run);
      const auto follow = [&](const Scene& to) {
        if (changed(delta)) session.update(std::make_shared<const Scene>(to), changed(delta));
        return finish(session);
      };
      const Picture done = follow(scene);
      Session fresh = make_session(scene, settings);
      EXPECT_TRUE(same_bits(done, finish(fresh))) << command.name << (editable ? ", editable" : "");
      EXPECT_TRUE(same_bits(follow(*before), original)) << command.name << ", undone";
    }
  }
}

}  // namespace
}  // namespace parian
