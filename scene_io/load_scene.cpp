#include "scene_io/gltf.h"

namespace parian {

Scene load_scene(const std::vector<std::string>& paths, const LoadSettings& settings,
                 std::vector<std::string>& warnings) {
  Scene scene;
  for (const std::string& path : paths) append(scene, load_gltf(path, settings, warnings));
  return scene;
}

}  // namespace parian
