/// glTF 2.0 files into a Scene, the only code that knows tinygltf.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian {

class ImageMemory;
struct GltfSource;

struct LoadSettings {
  std::function<void(const char* phase)> on_phase;  // told what begins, if set
  std::optional<double> at;  // seconds: the pose of the animations then; none: the pose of the file
  ImageMemory* image_memory = nullptr;  // what bounds the memory of images; nullptr: nothing does
  bool more_scenes = false;             // whether images of others will need some of it too
  /// Where what write_gltf() needs of the file goes, behind those that are there: its number there is the one
  /// that origins have. nullptr: it is not kept, and origins have `file`.
  std::vector<GltfSource>* sources = nullptr;
  int file = 0;
};

/// Reads, with its morph targets and skins applied, the default scene of a .gltf or .glb file (external files
/// and data URIs included), validated. Things that are skipped are named in `warnings`, one line each, each
/// at most once a file. Throws InputError.
Scene load_gltf(const std::string& path, const LoadSettings& settings, std::vector<std::string>& warnings);

/// All files as one scene, origins numbered by file. Throws InputError.
Scene load_scene(const std::vector<std::string>& paths, const LoadSettings& settings,
                 std::vector<std::string>& warnings);

}  // namespace parian
