/// What material extensions say, of a document whose values have been checked.
#pragma once

#include <vector>

#include "scene_io/gltf/materials/texture_table.h"

namespace parian {

inline Rgb to_rgb(const std::vector<double>& v) { return {float(v[0]), float(v[1]), float(v[2])}; }

/// Reads the extensions of one material into `material`, whose core members have been read.
void read_material_extensions(const tinygltf::ExtensionMap& extensions, TextureTable& textures,
                              Material& material);

}  // namespace parian
