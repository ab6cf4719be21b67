/// The shapes that triangles draw exactly.
#pragma once

#include "renderer/scene/scene.h"

namespace parian {

/// The box or plane as triangles with flat normals, its front outwards or towards +y. A face of a box has the
/// whole unit square as uv, upright on the four sides; on a plane u grows along x and v along z.
Primitive make_shape_primitive(const Shape& shape, int material);

}  // namespace parian
