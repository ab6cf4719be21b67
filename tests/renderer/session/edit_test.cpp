// Edits of a session: the picture of a session that never knew another scene; what of it is built anew.
#include "renderer/session/session.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/renderer/session/support/session_scenes.h"

namespace parian {
namespace {

using std::chrono::milliseconds;

struct Edit {
  const char* name;
  unsigned changed;
  std::function<void(Scene&)> apply;
  // What an editable and a plain session may rebuild.
  bool mesh_builds_plain, mesh_builds_editable, top_builds, light_builds;
};

std::vector<Edit> edits() {
  return {
      {"camera moved", kChangedCamera,
       [](Scene& s) {
         s.nodes[7].transform = look_along({-1, 1, 4}, normalize(Vec3f(0.2f, -0.2f, -1)));
       },
       false, false, false, false},
      {"camera changed", kChangedCamera,
       [](Scene& s) { s.cameras[0].yfov = 0.4f, s.cameras[0].lens.reset(); }, false, false, false, false},
      {"colour", kChangedMaterials,
       [](Scene& s) {
         s.materials[1].base_color = {0.9f, 0.1f, 0.1f}, s.materials[1].metallic = 0;
       },
       false, false, false, false},
      {"emission", kChangedMaterials,
       [](Scene& s) {
         s.materials[3].emission = {0, 5, 9}, s.materials[1].emission = {0.2f, 0, 0};
       },
       false, false, false, true},
      {"texture", kChangedMaterials, [](Scene& s) { s.materials[0].base_color_texture = {}; }, false, false,
       false, false},
      {"coverage", kChangedMaterials, [](Scene& s) { s.materials[2].alpha = 0.2f; }, false, false, false,
       false},
      {"opaque to blended", kChangedMaterials,
       [](Scene& s) { s.materials[1].alpha_mode = AlphaMode::blend, s.materials[1].alpha = 0.5f; }, true,
       false, true, false},
      {"brighter lights", kChangedLights,
       [](Scene& s) {
         s.lights[0].intensity = 20, s.lights[1].intensity = 0.1f, s.environment.radiance = Rgb(1, 0, 0);
       },
       false, false, true, true},
      {"light added", kChangedLights | kChangedTransforms,
       [](Scene& s) {
         add_light(s, make_area_light(LightKind::rectangle, 4, 1, 1), look_along({0, 2, -2}, {0, 0, 1}));
       },
       true, false, true, true},
      {"light removed", kChangedLights, [](Scene& s) { s.nodes[5].light = kNone; }, true, false, true, true},
      {"environment image", kChangedLights,
       [](Scene& s) {
         s.environment.image = int(s.images.size());
         s.images.push_back(make_image(4, 2, 1, PixelType::f32, std::vector<float>{1, 5, 2, 0, 0, 1, 3, 1}));
       },
       false, false, true, true},
      {"disk moved", kChangedTransforms,
       [](Scene& s) {
         s.nodes[5].transform = look_along({1, 2, 1}, normalize(Vec3f(-0.5f, -1, -0.5f)));
       },
       false, false, true, true},
      {"boxes moved", kChangedTransforms,
       [](Scene& s) {
         s.nodes[1].transform = translate({0, 0.5f, 0}), s.nodes[2].transform.scale = {1, 2, 1};
       },
       false, false, true, false},
      {"floor and emitter moved", kChangedTransforms,
       [](Scene& s) {
         s.nodes[0].transform = translate({0, 0.2f, 0}), s.nodes[4].transform = translate({-1, 1, 0});
       },
       true, false, true, true},
      {"solids moved", kChangedTransforms,
       [](Scene& s) {
         s.nodes[8].transform = translate({0.5f, 0.6f, 0.9f}), s.nodes[9].transform.scale = {1, 1, 2};
         s.nodes[11].transform = translate({-0.3f, 0.8f, 0.5f});
       },
       false, false, true, true},
      {"sphere squeezed", kChangedTransforms,
       [](Scene& s) {
         s.nodes[8].transform.scale = {1, 2, 1};
       },
       true, false, true, true},
      {"solid reshaped", kChangedGeometry,
       [](Scene& s) { s.shapes[0].radius = 0.4f, s.shapes[1].radius_top = 0, s.shapes[2].size.y = 0.6f; },
       true, true, true, true},
      {"mesh hidden", kChangedTransforms,
       [](Scene& s) {
         s.nodes[1].transform.scale = {0, 0, 0};
       },
       true, false, true, false},
      {"mesh added", kChangedGeometry,
       [](Scene& s) {
         add_mesh(s, make_box({1, 0, 1}, {1.5f, 0.5f, 1.5f}), 1);
       },
       true, true, true, false},
      {"mesh reshaped", kChangedGeometry,
       [](Scene& s) {
         const int material = s.meshes[1].primitives[0].material;
         s.meshes[1].primitives[0] = make_uv_sphere({0, 0.3f, 0}, 0.5f, 6);
         s.meshes[1].primitives[0].material = material;
       },
       true, true, true, false},
      {"all at once",
       kChangedCamera | kChangedMaterials | kChangedLights | kChangedTransforms | kChangedGeometry,
       [](Scene& s) {
         s = everything(), s.nodes[1].transform = {}, s.materials[1].metallic = 0, s.lights[1].intensity = 9;
       },
       true, true, true, true},
  };
}

// Each edit gives the picture of a session that never knew another scene, to the bit, and rebuilds no more
// than it must. Caught: lights or a camera left as they were, a film not cleared, vertices not moved, a BVH
// built for a colour.
TEST(Session, EditsMatchFreshSessions) {
  for (const bool editable : {false, true})
    for (const Edit& edit : edits()) {
      RenderSettings settings = small(4);
      settings.accel.editable = editable;
      settings.build = BuildQuality::balanced;  // that of the best holds copies
      const Scene scene = everything();
      Scene edited = scene;  // of the same arrays
      edit.apply(edited);
      Session session = make_session(scene, settings);
      finish(session);
      const SessionStats before = session.stats();
      validate(edited, edit.name);
      session.update(std::make_shared<const Scene>(edited), edit.changed);
      EXPECT_EQ(session.progress().samples, 0u);
      const Picture after = finish(session);
      Session fresh = make_session(edited, settings);
      const Picture expected = finish(fresh);
      EXPECT_TRUE(same_bits(after, expected)) << edit.name << (editable ? ", editable" : "");
      EXPECT_FALSE(same_bits(after, render_everything(settings))) << edit.name;

      const SessionStats stats = session.stats();
      const bool meshes = editable ? edit.mesh_builds_editable : edit.mesh_builds_plain;
      // A new Accel counts from nothing.
      const bool rebuilt = meshes && edit.top_builds && stats.builds.top_level == 1;
      EXPECT_EQ(rebuilt || stats.builds.meshes > before.builds.meshes, meshes)
          << edit.name << (editable ? ", editable" : "");
      EXPECT_EQ(rebuilt || stats.builds.top_level > before.builds.top_level, edit.top_builds) << edit.name;
      EXPECT_EQ(stats.light_builds > before.light_builds, edit.light_builds) << edit.name;
      // Of an editable scene no edit builds more than the one primitive that it brings.
      if (editable && edit.name != std::string("all at once")) {
        EXPECT_EQ(stats.builds.meshes - before.builds.meshes, int(meshes)) << edit.name;
      }
    }
}

// One after the other in one session.
TEST(Session, EditsAddUp) {
  RenderSettings settings = small(3);
  settings.accel.editable = true;
  Session session = make_session(everything(), settings);
  Scene scene = everything();
  for (const Edit& edit : edits()) {
    if (edit.name == std::string("all at once")) continue;
    edit.apply(scene);
    session.update(std::make_shared<const Scene>(scene), edit.changed);
  }
  Session fresh = make_session(scene, settings);
  EXPECT_TRUE(same_bits(finish(session), finish(fresh)));
}

TEST(Session, EditsWhileRenderingGoOnRendering) {
  RenderSettings settings = small(30);
  Session session = make_session(everything(), settings);
  session.start();
  Scene scene = everything();
  for (int i = 0; i < 6; ++i) {
    std::this_thread::sleep_for(milliseconds(5));
    scene.nodes[1].transform = translate({-1, 0.1f * float(i), 0});
    scene.nodes[7].transform =
        look_along({1, 1.5f + 0.1f * float(i), 4}, normalize(Vec3f(-0.25f, -0.3f, -1)));
    session.start();
    session.update(std::make_shared<const Scene>(scene), kChangedTransforms | kChangedCamera);
    EXPECT_TRUE(session.progress().running || session.progress().samples == 30);
  }
  session.wait();
  Session fresh = make_session(scene, settings);
  EXPECT_TRUE(same_bits(session.snapshot(), finish(fresh)));
}

}  // namespace
}  // namespace parian
