/// What is kept of a loaded file so that it can be written again with all that Parian has no use for.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian {

/// One file as load_gltf() read it. Its bytes stay in memory: what is saved later does not depend on what
/// became of the file.
struct GltfSource {
  std::string path;
  std::string_view json;                            // in `storage`
  std::vector<std::span<const std::byte>> buffers;  // the document's; empty: only a fallback, never read
  std::vector<SharedArray<std::byte>> storage;      // keeps both alive
  Scene loaded;                                     // as it came; shares all arrays

  // What the things in `loaded` are in the document. Of other kinds the numbers are the same.
  std::vector<int> textures, images;
  std::vector<int> meshes;                   // those deformed for some nodes alone stand behind the others
  std::vector<bool> deformed;                // by mesh: whether morph targets or a skin made its vertices
  std::vector<std::vector<int>> primitives;  // by mesh of `loaded`
  std::map<int, int> shown;                  // by node with a skin: the node in `loaded` that shows its mesh
  std::size_t nodes = 0;                     // in the document; in `loaded` there are more behind them
  std::size_t punctual_lights = 0;           // stand before the area lights

  // Where the file was loaded in the pose of its animations: the nodes that have another than in the file,
  // and their meshes' weights.
  std::map<int, std::vector<float>> posed;
};

}  // namespace parian
