// What is edited and saved renders the same picture, to the bit, as it does in the editor.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "editing/add.h"
#include "editing/materials.h"
#include "editing/nodes.h"
#include "integrators/integrators.h"
#include "renderer/session/session.h"
#include "scene_io/gltf/gltf.h"
#include "scene_io/gltf/source.h"
#include "scene_io/gltf/write/write.h"

namespace parian {
namespace {

namespace fs = std::filesystem;

Picture render(const Scene& scene) {
  RenderSettings settings;
  settings.width = 48;
  settings.height = 36;
  settings.spp = 2;
  Session session(std::make_shared<const Scene>(scene), settings, make_integrator("path", {}));
  session.start();
  session.wait();
  return session.snapshot();
}

/// Something of all that an editor does: a node moved, a copy, a shape with a material of its own, a light.
void change(Scene& scene) {
  Transform& place = scene.nodes[0].transform;
  const Vec3f moved = place.matrix ? Vec3f(0.02f, 0.01f, 0) : place.translation + Vec3f(0.02f, 0.01f, 0);
  edit::set_transform(scene, 0, {.translation = moved, .rotation = {}, .scale = {}});
  edit::duplicate(scene, 0);
  edit::Place at;
  at.transform.translation = {0.1f, 0.3f, 0.1f};
  const int ball = edit::add_shape(scene, edit::sphere(0.08f), at);
  Material red;
  red.base_color = Rgb(0.8f, 0.1f, 0.1f);
  red.roughness = 0.3f;
  const int material = edit::add_material(scene, red);
  edit::assign_material(scene, {ball, kNone}, material);
  Light lamp = edit::default_light(LightKind::point);
  lamp.intensity = 0.3f;
  at.transform.translation = {-0.1f, 0.4f, 0.3f};
  edit::add_light(scene, lamp, at);
}

class SavedPicture : public testing::TestWithParam<const char*> {};

TEST_P(SavedPicture, IsThatOfTheScene) {
  const fs::path folder = fs::temp_directory_path() / fmt::format("parian_saved_picture_{}", getpid());
  fs::create_directories(folder);
  std::vector<std::string> warnings;
  std::vector<GltfSource> sources;
  LoadSettings settings;
  settings.sources = &sources;
  Scene scene =
      load_gltf(fmt::format("{0}/scenes/{1}/{1}.gltf", PARIAN_SOURCE_DIR, GetParam()), settings, warnings);
  const Picture before = render(scene);
  change(scene);
  const Picture edited = render(scene);
  EXPECT_NE(edited.pixels, before.pixels);
  for (const char* name : {"saved.glb", "saved.gltf"}) {
    write_gltf(scene, sources, (folder / name).string());
    EXPECT_EQ(render(load_gltf((folder / name).string(), {}, warnings)).pixels, edited.pixels) << name;
  }
  fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SavedPicture,
                         testing::Values("cornell-box", "lights", "textured", "glass-still-life", "instances",
                                         "shapes-still-life", "subsurface-balls", "environment-sun"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace parian
