/// Triangles traced as quads: Embree keeps two triangles that share an edge in two thirds of the memory that
/// it takes for them one by one, builds half as many primitives, and traces them no slower
/// (docs/large.md). A triangle without partner is a quad whose second half has no area.
#pragma once

#include <array>
#include <cstdint>
#include <utility>

#include "renderer/scene/world.h"

namespace parian {

/// Corners of a quad, which Embree splits into the triangles (0, 1, 3) and (2, 3, 1).
using Quad = std::array<std::uint32_t, 4>;

/// A point of a triangle of a mesh, at barycentric weights (1 - u - v, u, v).
struct TrianglePoint {
  std::uint32_t triangle;
  float u, v;
};

/// From a quad back to its triangles, in one read.
struct PairOrigin {
  std::uint32_t first;                 // triangle
  std::uint8_t step;                   // the second triangle is first + step; 0: there is none
  std::uint8_t corner, second_corner;  // of each triangle the one that is not on the shared edge
  bool turned;                         // the second triangle is wound the other way
};

/// The triangle and the weights where Embree reports (u, v) of a quad of that origin.
inline TrianglePoint triangle_point(const PairOrigin& origin, float u, float v) {
  const bool second = u + v > 1 && origin.step != 0;
  // Weights of the corner off the shared edge and of the two after it. Embree gives a point (u', v') of the
  // second half, corners (2, 3, 1), as (1 - u', 1 - v').
  float off = second ? u + v - 1 : 1 - u - v, next = second ? 1 - u : u, last = second ? 1 - v : v;
  if (second && origin.turned) std::swap(next, last);
  const std::uint32_t triangle = origin.first + (second ? origin.step : 0);
  switch (second ? origin.second_corner : origin.corner) {
    case 0:
      return {triangle, next, last};
    case 1:
      return {triangle, off, next};
    default:
      return {triangle, last, off};
  }
}

struct TrianglePairs {
  SharedArray<Quad> quads;
  SharedArray<PairOrigin> origins;  // that find_origins() adds

  std::size_t bytes() const { return quads.bytes() + origins.bytes(); }

  /// The triangle and the weights where Embree reports (u, v) of a quad.
  TrianglePoint point(std::uint32_t quad, float u, float v) const {
    return triangle_point(origins[quad], u, v);
  }
};

/// Pairs triangles that share an edge and lie near each other in the list, in parallel; the result depends on
/// the list alone. It lacks the way back to them.
TrianglePairs pair_triangles(const SharedArray<Triangle>& triangles);

/// Adds the way back to the triangles that the pairs were made of. Apart, since Embree's build, when memory
/// is short, does not need it.
void find_origins(TrianglePairs& pairs, const SharedArray<Triangle>& triangles);

/// The number of quads that pair_triangles() makes, estimated from parts of a long list.
double estimate_quads(const SharedArray<Triangle>& triangles);

}  // namespace parian
