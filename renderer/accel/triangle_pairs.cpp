#include "renderer/accel/triangle_pairs.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "renderer/base/parallel.h"

namespace parian {
namespace {

// Triangles are paired within chunks, so that these can be worked on side by side.
constexpr std::size_t kChunk = std::size_t(1) << 14;
// How far ahead a partner is looked for. Most meshes were quads or strips and have it next.
constexpr std::size_t kReach = 16;
// Chunks that an estimate looks at.
constexpr std::size_t kSamples = 16;

constexpr std::uint8_t kSecond = 0xff;  // as a step: the triangle is the second of a pair

struct SharedEdge {
  int a, b;  // the corners that are not on it
};

/// The edge that two triangles share where they share just one and each has three corners; else a = -1.
SharedEdge shared_edge(const Triangle& a, const Triangle& b) {
  const auto in = [](std::uint32_t v, const Triangle& t) { return int(v == t[0] || v == t[1] || v == t[2]); };
  const int b0 = in(b[0], a), b1 = in(b[1], a), b2 = in(b[2], a);
  if (b0 + b1 + b2 != 2) return {-1, -1};
  const int a0 = in(a[0], b), a1 = in(a[1], b), a2 = in(a[2], b);
  if (a0 + a1 + a2 != 2) return {-1, -1};
  return {a0 ? (a1 ? 2 : 1) : 0, b0 ? (b1 ? 2 : 1) : 0};
}

/// Fills in the step of each triangle of a chunk and returns the number of quads.
std::size_t pair_chunk(std::span<const Triangle> triangles, std::uint8_t* steps) {
  std::fill_n(steps, triangles.size(), std::uint8_t(0));
  std::size_t quads = triangles.size();
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (steps[i] == kSecond) continue;
    const std::size_t end = std::min(triangles.size(), i + 1 + kReach);
    for (std::size_t k = i + 1; k < end; ++k) {
      if (steps[k] == kSecond || shared_edge(triangles[i], triangles[k]).a < 0) continue;
      steps[i] = std::uint8_t(k - i);
      steps[k] = kSecond;
      --quads;
      break;
    }
  }
  return quads;
}

std::span<const Triangle> chunk_of(const SharedArray<Triangle>& triangles, std::size_t chunk) {
  const std::size_t begin = chunk * kChunk;
  return {triangles.data() + begin, std::min(kChunk, triangles.size() - begin)};
}

std::size_t chunk_count(const SharedArray<Triangle>& triangles) {
  return (triangles.size() + kChunk - 1) / kChunk;
}

Quad make_quad(const Triangle& a, const Triangle& b) {
  const SharedEdge edge = shared_edge(a, b);
  return {a[edge.a], a[(edge.a + 1) % 3], b[edge.b], a[(edge.a + 2) % 3]};
}

/// The corner of a triangle that is vertex v.
int corner_of(const Triangle& t, std::uint32_t v) { return t[0] == v ? 0 : t[1] == v ? 1 : 2; }

}  // namespace

TrianglePairs pair_triangles(const SharedArray<Triangle>& triangles) {
  const std::size_t chunks = chunk_count(triangles);
  auto [step, steps] = make_shared_array<std::uint8_t>(triangles.size());
  std::vector<std::size_t> before(chunks + 1, 0);  // quads of the chunks before each
  parallel_for(chunks, 1, [&, steps = steps](std::size_t c) {
    before[c + 1] = pair_chunk(chunk_of(triangles, c), steps + c * kChunk);
  });
  for (std::size_t c = 0; c < chunks; ++c) before[c + 1] += before[c];
  auto [quads, quad] = make_shared_array<Quad>(before.back());
  auto [first, first_of] = make_shared_array<std::uint32_t>(before.back());
  auto [step_by_quad, step_of] = make_shared_array<std::uint8_t>(before.back());
  parallel_for(chunks, 1,
               [&, steps = steps, quad = quad, first_of = first_of, step_of = step_of](std::size_t c) {
                 std::size_t q = before[c];
                 const std::size_t end = std::min(triangles.size(), (c + 1) * kChunk);
                 for (std::size_t i = c * kChunk; i < end; ++i) {
                   if (steps[i] == kSecond) continue;
                   const Triangle& t = triangles[i];
                   quad[q] = steps[i] ? make_quad(t, triangles[i + steps[i]]) : Quad{t[0], t[1], t[2], t[2]};
                   first_of[q] = std::uint32_t(i);
                   step_of[q++] = steps[i];
                 }
               });
  return {std::move(quads), std::move(first), std::move(step_by_quad)};
}

double estimate_quads(const SharedArray<Triangle>& triangles) {
  const std::size_t chunks = chunk_count(triangles), looked_at = std::min(chunks, kSamples);
  std::vector<std::uint8_t> steps(kChunk);
  std::size_t quads = 0, seen = 0;
  for (std::size_t i = 0; i < looked_at; ++i) {
    const auto chunk = chunk_of(triangles, i * chunks / looked_at);
    quads += pair_chunk(chunk, steps.data());
    seen += chunk.size();
  }
  return seen ? double(quads) / double(seen) * double(triangles.size()) : 0;
}

TrianglePoint TrianglePairs::point(const SharedArray<Triangle>& triangles, std::uint32_t quad, float u,
                                   float v) const {
  const Quad& corners = quads[quad];
  const bool second = u + v > 1 && step[quad] != 0;
  const std::uint32_t triangle = first[quad] + (second ? step[quad] : 0);
  const Triangle& t = triangles[triangle];
  // Of the corner off the shared edge and the two after it; Embree gives a point (u', v') of the second half
  // (2, 3, 1) as (1 - u', 1 - v').
  const int off = corner_of(t, corners[second ? 2 : 0]), next = (off + 1) % 3, last = (off + 2) % 3;
  std::array<float, 3> weight;
  weight[off] = second ? u + v - 1 : 1 - u - v;
  weight[next] = second ? 1 - u : u;
  weight[last] = second ? 1 - v : v;
  if (second && t[next] != corners[3]) std::swap(weight[next], weight[last]);  // wound the other way
  return {triangle, weight[1], weight[2]};
}

}  // namespace parian
