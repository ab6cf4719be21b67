/// Meshes of the scene in the document.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <vector>

#include "scene_io/gltf/write/draft.h"

namespace parian {

/// How a mesh is written whose vertices the file deforms, by morph targets or a skin.
enum class MeshForm {
  source,  // as the file has it: reading it deforms it again
  baked    // the vertices that it has now, and nothing that deforms them
};

/// Whether the mesh can have the form `source`: all its primitives are still those of the file. Where nothing
/// deforms it, it may have changed ones too.
bool is_unchanged(const Draft& draft, const Mesh& mesh);

/// Whether the file deforms it.
bool is_deformed(const Draft& draft, const Mesh& mesh);

/// The JSON of a mesh. `target` is that of the file, with numbers of root, or an empty object.
void write_mesh(Draft& draft, const Mesh& mesh, MeshForm form, nlohmann::json& target);

}  // namespace parian
