/// What ties the vertices of a primitive to the joints of a skin.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scene_io/gltf/geometry/accessor.h"

namespace parian {

/// Up to four joints of each vertex, with their weights.
struct Influences {
  SharedArray<Vec4f> joints, weights;
};

/// JOINTS_n and WEIGHTS_n for n from 0 on, an element for each of `vertices`: joints below `joints`, weights
/// not negative. `source` is the primitive in the document and `where` its JSON path. Throws InputError.
std::vector<Influences> read_influences(const GltfDocument& document, AccessorReader& accessors,
                                        const tinygltf::Primitive& source, std::size_t joints,
                                        std::size_t vertices, const std::string& where);

}  // namespace parian
