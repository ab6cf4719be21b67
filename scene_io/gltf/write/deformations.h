/// Which meshes are written as the file has them, to be deformed again when it is read.
#pragma once

#include <vector>

#include "scene_io/gltf/write/meshes.h"

namespace parian {

/// What reading the file makes once more of morph targets and skins is not written: it would be there twice.
/// That goes as long as nothing was changed that counts: the mesh, its joints' places, the node that shows
/// it. Else what the scene has is written without what deforms it.
struct Deformations {
  /// By node of the scene, the mesh that its element in root has; kNone: none.
  std::vector<int> mesh;
  /// By node: whether its element keeps the file's skin, and its weights.
  std::vector<bool> keeps_skin, keeps_weights;
  /// By node: whether reading the file makes it, and it is left out; and by node that keeps a skin, the one
  /// so made.
  std::vector<bool> is_made;
  std::vector<int> made;
  /// By mesh of the scene.
  std::vector<MeshForm> forms;
  /// Meshes of the scene that root has a second time, baked, behind all others: for nodes that the file does
  /// not deform them for.
  std::vector<int> also_baked;
};

/// root's nodes have the elements of their sources.
Deformations find_deformations(const Draft& draft);

}  // namespace parian
