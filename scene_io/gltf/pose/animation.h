/// The animations of a document at one time.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "renderer/scene/scene.h"
#include "scene_io/gltf/geometry/accessor.h"

namespace parian {

/// What animations give a node; what they leave keeps the value of the file.
struct NodePose {
  std::optional<Vec3f> translation, scale;
  std::optional<Quatf> rotation;
  std::optional<std::vector<float>> weights;  // of the mesh's morph targets, one for each
};

/// By node of the document.
using Pose = std::map<int, NodePose>;

/// All animations of the document, each at `seconds` since its own beginning and held before its first and
/// after its last key. Where several give one property of a node, the last in the file counts. Throws
/// InputError.
Pose read_pose(const GltfDocument& document, AccessorReader& accessors, double seconds);

}  // namespace parian
