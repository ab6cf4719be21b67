/// What the solids share: where a line crosses one, and a point of its surface.
#pragma once

#include <cstdint>

#include "renderer/base/math.h"

namespace parian {

/// The parts of a solid's surface. A sphere is all side.
enum class Face : std::uint8_t { side, top, bottom };

struct Crossing {
  double t;  // along the line, in units of its direction
  Face face;
};

/// The solids are convex, so a line lies inside one between two crossings, or meets it not at all: from
/// outside the number of crossings is even by construction. enter.t <= leave.t.
struct Chord {
  Crossing enter, leave;
};

/// A point of the surface, in the solid's space.
struct SolidPoint {
  Vec3f normal;  // unit, outwards
  Vec2f uv;      // in [0, 1]; v = 0 is the top row of a texture, which is not mirrored seen from outside
  Vec3f dpdu;    // the direction in which u grows, of any length; zero where there is none
};

struct SurfaceSample {
  Vec3f p;
  Face face;
};

}  // namespace parian
