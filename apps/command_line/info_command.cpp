#include <fmt/format.h>

#include "apps/command_line/commands.h"
#include "apps/command_line/picture_size.h"
#include "apps/command_line/sizes.h"
#include "apps/command_line/texture_memory.h"
#include "images/image_io.h"
#include "renderer/base/memory.h"
#include "renderer/session/build_plan.h"
#include "scene_io/gltf/gltf.h"
#include "scene_io/statistics.h"

namespace parian {
namespace {

struct InfoOptions {
  std::vector<std::string> scenes;
  LoadSettings load_settings;
  std::string size, memory, texture_memory;
};

/// What the render of the scene's first camera would take, with default settings; or why it cannot be.
std::string describe_memory(const Scene& scene, const World& world, const InfoOptions& o,
                            std::size_t at_end) {
  RenderSettings settings;
  settings.memory_at_end = at_end;
  const Vec2i size = !o.size.empty()         ? parse_size(o.size)
                     : world.cameras.empty() ? default_size({})
                                             : default_size(scene.cameras[world.cameras[0].camera]);
  settings.width = size.x;
  settings.height = size.y;
  try {
    return plan_build(scene, world, settings).describe();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

int info(const InfoOptions& o) {
  if (!o.memory.empty()) set_memory_limit(parse_bytes("--memory", o.memory));
  memory_limit();
  const std::size_t at_end = resident_memory() + image_library_bytes();
  std::vector<std::string> notes;
  const std::unique_ptr<ImageMemory> images = make_image_memory(o.texture_memory);
  LoadSettings settings = o.load_settings;
  settings.image_memory = images.get();
  const Scene scene = load_scene(o.scenes, settings, notes);
  const World world = make_world(scene);
  fmt::print("{}", describe(scene, world));
  fmt::print("{:<12} {}\n", "rendering", describe_memory(scene, world, o, at_end));
  for (const std::string& note : notes) fmt::print("{:<12} {}\n", "note", note);
  return kDone;
}

}  // namespace

Command add_info_command(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("info", "Say what is in a scene and what memory it will take");
  const auto options = std::make_shared<InfoOptions>();
  InfoOptions& o = *options;
  c.add_option("SCENE", o.scenes, ".gltf or .glb files; several are composed into one scene")->required();
  c.add_option("--size", o.size, "Size of the picture; by default 960 wide in the camera's shape")
      ->type_name("WxH");
  c.add_option("--memory", o.memory,
               "Memory to stay below, as 8G or 500M; what the machine has free by default")
      ->type_name("BYTES");
  add_texture_memory(c, o.texture_memory);
  add_at_option(c, o.load_settings.at);
  return [options] { return info(*options); };
}

}  // namespace parian
