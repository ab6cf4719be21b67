#include <fmt/format.h>

#include "renderer/apps/commands.h"
#include "scene_io/gltf.h"
#include "scene_io/statistics.h"

namespace parian {

Command add_info_command(CLI::App& app) {
  CLI::App& c = *app.add_subcommand("info", "Say what is in a scene and what memory it will take");
  const auto scenes = std::make_shared<std::vector<std::string>>();
  const auto settings = std::make_shared<LoadSettings>();
  c.add_option("SCENE", *scenes, ".gltf or .glb files; several are composed into one scene")->required();
  add_at_option(c, settings->at);
  return [scenes, settings] {
    std::vector<std::string> warnings;
    const Scene scene = load_scene(*scenes, *settings, warnings);
    fmt::print("{}", describe(scene, make_world(scene)));
    for (const std::string& warning : warnings) fmt::print("{:<12} {}\n", "note", warning);
    return kDone;
  };
}

}  // namespace parian
