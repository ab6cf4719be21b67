#include "renderer/light/emissive_triangles.h"

namespace parian {
namespace {

// Records of up to this many triangles stay in the cache, and save what make() takes: 60 instructions and, of
// a mesh that is larger than the cache, nothing.
constexpr std::size_t kMaxRecords = 1024;
// A search begins among the emitters of this many triangles, at most as many.
constexpr std::size_t kGuided = 64;

struct Edges {
  Vec3f e1, e2;
  float area() const { return 0.5f * e1.cross(e2).length(); }
};

/// In world space.
Edges edges(const Affine& to_world, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  return {to_world.vector(b - a), to_world.vector(c - a)};
}

}  // namespace

EmissiveTriangles::EmissiveTriangles(const World& world) : world_(&world) {
  bool emissive = false;
  for (const Part& part : world.parts) emissive |= part.emissive;
  if (!emissive) return;
  first_.reserve(world.slot_count);
  for (std::uint32_t i = 0; i < world.placements.size(); ++i) {
    const Placement& placement = world.placements[i];
    for (std::uint32_t k = 0; k < placement.part_count; ++k) {
      first_.push_back(std::uint32_t(size_));
      const Part& part = world.parts[placement.first_part + k];
      const std::size_t count = part.emissive ? part.primitive->triangles.size() : 0;
      if (count > 0) emitters_.push_back({std::uint32_t(size_), i, placement.first_part + k});
      size_ += count;
    }
  }
  emitters_.shrink_to_fit();
  guide_.reserve(size_ / kGuided + 2);
  for (std::uint32_t i = 0; i < emitters_.size(); ++i) {
    const std::size_t end = i + 1 < emitters_.size() ? emitters_[i + 1].first : size_;
    while (guide_.size() * kGuided < end) guide_.push_back(i);
  }
  if (!emitters_.empty()) guide_.push_back(std::uint32_t(emitters_.size()) - 1);
  if (size_ > kMaxRecords) return;
  std::vector<EmissiveTriangle> records;
  for (std::uint32_t i = 0; i < size_; ++i) records.push_back(make(int(i)));
  records_ = std::move(records);
}

const EmissiveTriangles::Emitter& EmissiveTriangles::emitter_of(std::uint32_t number) const {
  std::uint32_t first = guide_[number / kGuided];
  for (std::uint32_t count = guide_[number / kGuided + 1] - first + 1; count > 1;) {
    const std::uint32_t half = count / 2;
    if (emitters_[first + half].first <= number) first += half;
    count -= half;
  }
  return emitters_[first];
}

EmissiveTriangle EmissiveTriangles::make(int number) const {
  const Emitter& emitter = emitter_of(std::uint32_t(number));
  const Part& part = world_->parts[emitter.part];
  const Placement& placement = world_->placements[emitter.placement];
  const Affine& m = placement.to_world;
  const std::uint32_t k = std::uint32_t(number) - emitter.first;
  const Triangle& t = part.primitive->triangles[k];
  const Vec3f &a = part.primitive->positions[t[0]], &b = part.primitive->positions[t[1]],
              &c = part.primitive->positions[t[2]];
  const Edges e = edges(m, a, b, c);
  const Vec3f normal = m.normal((b - a).cross(c - a));
  return {m.point(a), e.e1,
          e.e2,       normal.normalized(),
          e.area(),   plane_offset(placement.extent(max_component(max(abs(a), max(abs(b), abs(c)))))),
          &part,      k};
}

float EmissiveTriangles::world_area(const Hit& hit) const {
  const Placement& placement = world_->placements[hit.placement];
  const Primitive& primitive = *world_->parts[placement.first_part + hit.primitive].primitive;
  const Triangle& t = primitive.triangles[hit.triangle];
  return edges(placement.to_world, primitive.positions[t[0]], primitive.positions[t[1]],
               primitive.positions[t[2]])
      .area();
}

std::size_t EmissiveTriangles::bytes() const {
  return first_.capacity() * sizeof(std::uint32_t) + emitters_.capacity() * sizeof(Emitter) +
         guide_.capacity() * sizeof(std::uint32_t) + records_.capacity() * sizeof(EmissiveTriangle);
}

std::size_t EmissiveTriangles::predicted_bytes(std::size_t triangles, std::size_t slots) {
  return slots * (sizeof(std::uint32_t) + sizeof(Emitter)) +
         (triangles / kGuided + 2) * sizeof(std::uint32_t) +
         (triangles <= kMaxRecords ? triangles * sizeof(EmissiveTriangle) : 0);
}

}  // namespace parian
