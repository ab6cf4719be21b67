/// Triangles traced as quads: Embree keeps two triangles that share an edge in two thirds of the memory that
/// it takes for them one by one, builds half as many primitives, and traces them no slower
/// (docs/measurements.md). A triangle without partner is a quad whose second half has no area.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/scene/world.h"

namespace parian {

/// Corners of a quad, which Embree splits into the triangles (0, 1, 3) and (2, 3, 1).
using Quad = std::array<std::uint32_t, 4>;

/// A point of a triangle of a mesh, at barycentric weights (1 - u - v, u, v).
struct TrianglePoint {
  std::uint32_t triangle;
  float u, v;
};

struct TrianglePairs {
  SharedArray<Quad> quads;
  SharedArray<std::uint32_t> first;  // triangle of each quad
  SharedArray<std::uint8_t> step;    // its second triangle is first + step; 0: it has none

  std::size_t bytes() const { return quads.bytes() + first.bytes() + step.bytes(); }

  /// The triangle and the weights where Embree reports (u, v) of a quad; `triangles` are those it was made
  /// of.
  TrianglePoint point(const SharedArray<Triangle>& triangles, std::uint32_t quad, float u, float v) const;
};

/// Pairs triangles that share an edge and lie near each other in the list, in parallel; the result depends on
/// the list alone.
TrianglePairs pair_triangles(const SharedArray<Triangle>& triangles);

/// The number of quads that pair_triangles() makes, estimated from parts of a long list.
double estimate_quads(const SharedArray<Triangle>& triangles);

}  // namespace parian
