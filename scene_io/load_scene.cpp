#include <utility>

#include "scene_io/gltf/gltf.h"

namespace parian {

Scene load_scene(const std::vector<std::string>& paths, const LoadSettings& settings,
                 std::vector<std::string>& warnings) {
  Scene scene;
  LoadSettings each = settings;
  for (const std::string& path : paths) {
    each.more_scenes = settings.more_scenes || &path != &paths.back();
    each.file = settings.file + int(&path - &paths.front());
    Scene loaded = load_gltf(path, each, warnings);
    if (&path == &paths.front())
      scene = std::move(loaded);
    else
      append(scene, loaded);
  }
  return scene;
}

}  // namespace parian
