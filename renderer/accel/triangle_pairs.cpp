#include "renderer/accel/triangle_pairs.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "renderer/base/memory.h"
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

/// From each triangle to its partner, if that comes later.
class Steps {
 public:
  explicit Steps(const SharedArray<Triangle>& triangles)
      : size_(triangles.size()), before_(chunk_count(triangles) + 1, 0) {
    auto [array, steps] = make_shared_array<std::uint8_t>(size_);
    steps_ = std::move(array);
    parallel_for(before_.size() - 1, 1, [&, steps = steps](std::size_t c) {
      before_[c + 1] = pair_chunk(chunk_of(triangles, c), steps + c * kChunk);
    });
    for (std::size_t c = 1; c < before_.size(); ++c) before_[c] += before_[c - 1];
  }

  std::size_t quads() const { return before_.back(); }

  /// Calls body(quad, its first triangle, step to the second or 0) for all quads, in parallel.
  template <class Body>
  void for_each(const Body& body) const {
    parallel_for(before_.size() - 1, 1, [&](std::size_t c) {
      std::size_t quad = before_[c];
      for (std::size_t i = c * kChunk; i < std::min(size_, (c + 1) * kChunk); ++i)
        if (steps_[i] != kSecond) body(quad++, i, steps_[i]);
    });
  }

 private:
  std::size_t size_;
  std::vector<std::size_t> before_;  // quads of the chunks before each
  SharedArray<std::uint8_t> steps_;
};

}  // namespace

TrianglePairs pair_triangles(const SharedArray<Triangle>& triangles) {
  const Steps steps(triangles);
  auto [quads, quad] = make_page_array<Quad>(steps.quads());
  steps.for_each([&, quad = quad](std::size_t q, std::size_t i, std::uint8_t step) {
    const Triangle& t = triangles[i];
    quad[q] = step ? make_quad(t, triangles[i + step]) : Quad{t[0], t[1], t[2], t[2]};
  });
  return {std::move(quads), {}};
}

void find_origins(TrianglePairs& pairs, const SharedArray<Triangle>& triangles) {
  const Steps steps(triangles);
  auto [origins, origin] = make_page_array<PairOrigin>(steps.quads());
  steps.for_each([&, origin = origin](std::size_t q, std::size_t i, std::uint8_t step) {
    PairOrigin& o = origin[q];
    o = {std::uint32_t(i), step, 0, 0, false};
    if (step == 0) return;
    const Triangle &a = triangles[i], &b = triangles[i + step];
    const SharedEdge edge = shared_edge(a, b);
    o.corner = std::uint8_t(edge.a);
    o.second_corner = std::uint8_t(edge.b);
    o.turned = b[(edge.b + 1) % 3] != a[(edge.a + 2) % 3];
  });
  pairs.origins = std::move(origins);
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

}  // namespace parian
