/// glTF 2.0 files into a Scene, the only code that knows tinygltf.
#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian {

/// Reads the default scene of a .gltf or .glb file (external files and data URIs included), validated. Things
/// that are skipped are named in `warnings`, one line each, each at most once a file. Throws InputError.
Scene load_gltf(const std::string& path, std::vector<std::string>& warnings);

/// All files as one scene. Throws InputError.
Scene load_scene(const std::vector<std::string>& paths, std::vector<std::string>& warnings);

}  // namespace parian
