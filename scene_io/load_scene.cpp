#include <utility>

#include "scene_io/gltf.h"

namespace parian {

Scene load_scene(const std::vector<std::string>& paths, const LoadSettings& settings,
                 std::vector<std::string>& warnings) {
  Scene scene;
  for (const std::string& path : paths) {
    Scene loaded = load_gltf(path, settings, warnings);
    if (&path == &paths.front())
      scene = std::move(loaded);
    else
      append(scene, loaded);
  }
  return scene;
}

}  // namespace parian
