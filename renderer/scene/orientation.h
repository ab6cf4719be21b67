/// Which side of a closed surface is inside.
#pragma once

#include <span>

#include "renderer/scene/scene.h"

namespace parian {

/// Whether primitives that together close a volume have their front inside: then whoever made them wound
/// their triangles the wrong way. False where they close none.
bool is_inside_out(std::span<const Primitive* const> primitives);

}  // namespace parian
