/// Where the bytes of a document lie in its one buffer.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "scene_io/gltf/write/draft.h"

namespace parian {

/// Gives the bufferViews that are left their places: those of the sources keep their order and their bytes,
/// once where several have the same, with their offsets modulo 4; new ones follow. Buffers that are there
/// only to fall back to stay as they are behind the first. Returns what the buffer is made of, gaps included.
std::vector<Piece> lay_out(Draft& draft);

std::size_t total_bytes(const std::vector<Piece>& pieces);

}  // namespace parian
