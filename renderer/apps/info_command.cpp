#include <fmt/format.h>

#include "renderer/apps/commands.h"
#include "renderer/apps/texture_memory.h"
#include "scene_io/gltf.h"
#include "scene_io/statistics.h"

namespace parian {

Command add_info_command(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("info", "Say what is in a scene and what memory it will take");
  const auto scenes = std::make_shared<std::vector<std::string>>();
  c.add_option("SCENE", *scenes, ".gltf or .glb files; several are composed into one scene")->required();
  const auto cap = std::make_shared<std::string>();
  add_texture_memory(c, *cap);
  return [scenes, cap] {
    std::vector<std::string> warnings;
    const std::unique_ptr<ImageMemory> memory = make_image_memory(*cap);
    const Scene scene = load_scene(*scenes, {.on_phase = {}, .image_memory = memory.get()}, warnings);
    fmt::print("{}", describe(scene, make_world(scene)));
    for (const std::string& warning : warnings) fmt::print("{:<12} {}\n", "note", warning);
    return kDone;
  };
}

}  // namespace parian
