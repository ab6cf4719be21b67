/// The extensions of materials.
#pragma once

#include "scene_io/gltf/write/texture_use.h"

namespace parian {

/// Writes into the material `target`, which reads as `before`, what `now` has and it has not.
void write_material_extensions(nlohmann::json& target, const Material& now, const Material& before,
                               const TextureUses& textures);

}  // namespace parian
