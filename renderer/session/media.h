/// Which media surround a point.
#pragma once

#include "renderer/accel/accel.h"

namespace parian {

/// The media whose surfaces enclose p, outermost first: along each of three rays the surfaces that it leaves
/// more often than it enters them; two rays at least must agree, which bears a hole in a mesh.
MediumStack find_media(const World& world, const Accel& accel, const Vec3f& p);

}  // namespace parian
