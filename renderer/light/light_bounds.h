/// What the choice of a light knows of it, and of whom it is chosen for.
#pragma once

#include "renderer/base/math.h"

namespace parian {

/// Whom light is sampled for: a point and the unit normal of the side that receives; zero where both sides
/// do.
struct Receiver {
  Vec3f p, n;
};

/// What the tree knows of a light. It shines within the angle theta_e of some direction in the cone of half
/// angle theta_o around `axis`, and, where it is two-sided, of the opposite ones: a flat light within 90
/// degrees of its normal, a point light everywhere.
struct LightBounds {
  Box3f box;
  Vec3f axis{0, 0, 0};  // unit; any where theta_o is 180 degrees
  float cos_o = 1, cos_e = 0;
  float intensity = 0;      // radiant, along the axis: W/sr, in luminance. 0: never chosen
  float range = kInfinity;  // beyond this, from its box, it reaches nothing
  bool two_sided = false;
};

}  // namespace parian
