/// The triangles of meshes that emit, numbered, without a record for each where they are many.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/scene/surface.h"

namespace parian {

/// A triangle of a placed mesh as a light, in world space.
struct EmissiveTriangle {
  Vec3f v0, e1, e2, ng;
  float area, offset;
  const Part* part;
  std::uint32_t triangle;  // of part->primitive
};

/// Those of a world, which must outlive this, numbered by slot and triangle.
class EmissiveTriangles {
 public:
  EmissiveTriangles() = default;
  explicit EmissiveTriangles(const World& world);

  int size() const { return int(size_); }
  /// Where they are few, each as it is; else empty, and make() finds what one is from the mesh.
  std::span<const EmissiveTriangle> records() const { return records_; }
  EmissiveTriangle make(int number) const;
  /// The number of a triangle that was hit, and its area as make() has it.
  int number(const Hit& hit) const {
    return int(first_[world_->placements[hit.placement].first_slot + hit.primitive] + hit.triangle);
  }
  float area(const Hit& hit, int number) const {
    return records_.empty() ? world_area(hit) : records_[std::size_t(number)].area;
  }

  std::size_t bytes() const;
  /// What bytes() is for so many triangles of so many placed primitives, none of which is dark.
  static std::size_t predicted_bytes(std::size_t triangles, std::size_t slots);

 private:
  /// A placed primitive that emits.
  struct Emitter {
    std::uint32_t first;  // number of its first triangle
    std::uint32_t placement, part;
  };

  const Emitter& emitter_of(std::uint32_t number) const;
  float world_area(const Hit& hit) const;

  const World* world_ = nullptr;
  std::size_t size_ = 0;
  std::vector<std::uint32_t> first_;  // by slot: number of its first triangle; empty where no mesh emits
  std::vector<Emitter> emitters_;
  std::vector<std::uint32_t> guide_;  // the emitter of each kGuided-th triangle
  std::vector<EmissiveTriangle> records_;
};

}  // namespace parian
