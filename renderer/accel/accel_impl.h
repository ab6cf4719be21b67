/// What an Accel holds. Its queries are in accel.cpp; how it is built, and follows edits, in accel_build.cpp.
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include "renderer/accel/mesh_bvh.h"
#include "renderer/accel/mesh_uses.h"
#include "renderer/accel/query.h"
#include "renderer/accel/solid_geometry.h"

namespace parian {

/// What Embree gives as an id where there is none.
inline constexpr std::uint32_t kInvalidId = RTC_INVALID_GEOMETRY_ID;

/// Calls keep(i) for each hit that Embree asks about, and turns it away where that is false.
template <class Keep>
void filter_hits(const RTCFilterFunctionNArguments* a, const Keep& keep) {
  for (unsigned i = 0; i < a->N; ++i)
    if (a->valid[i] == -1 && !keep(i)) a->valid[i] = 0;
}

struct Accel::Impl {
  // A top-level geometry id means: a primitive in world space, an instance of a mesh, all area lights, or
  // (placement kSolid) the solids of solid_geometries[primitive].
  struct TopEntry {
    std::uint32_t placement, primitive;
  };

  Impl(const Scene& s, const World& w, const AccelSettings& settings, const Impl* before,
       const std::atomic<bool>* cancelled);
  ~Impl() {
    if (top) rtcReleaseScene(top);
  }

  Query query(const std::uint32_t* random, bool coherent) const {
    return Query(this, scene, world, random, coherent);
  }

  /// `normal()` is what Embree reports as the normal.
  template <class Normal>
  Hit to_hit(float t, float u, float v, unsigned instance, unsigned geometry, unsigned triangle,
             const Normal& normal) const {
    if (geometry == kInvalidId) return {t, u, v, Hit::kMiss, 0, 0, 0};
    const bool instanced = instance != kInvalidId;
    const TopEntry& entry = entries[instanced ? instance : geometry];
    if (entry.placement == Hit::kSolid) [[unlikely]]
      return to_solid_hit(solid_geometries[entry.primitive], t, triangle, u, normal());
    const std::uint32_t primitive = instanced ? geometry : entry.primitive;
    if (origins.empty() || entry.placement == Hit::kAreaLightHit)
      return {t, u, v, entry.placement, primitive, triangle, 0};
    const TrianglePoint p = point(entry.placement, primitive, triangle, u, v);
    return {t, p.u, p.v, entry.placement, primitive, p.triangle, 0};
  }

  /// The triangle that a primitive of Embree's is, or has where it is a pair.
  TrianglePoint point(std::uint32_t placement, std::uint32_t primitive, std::uint32_t traced, float u,
                      float v) const {
    if (origins.empty()) return {traced, u, v};
    const PairOrigin* pairs = origins[world->placements[placement].first_part + primitive];
    return pairs ? triangle_point(pairs[traced], u, v) : TrianglePoint{traced, u, v};
  }

  static void collect(const RTCFilterFunctionNArguments* a);
  static void alpha_filter(const RTCFilterFunctionNArguments* a);

  std::span<const Part> parts_of(const Placement& p) const {
    return std::span(world->parts).subspan(p.first_part, p.part_count);
  }
  /// By the first array of triangles, which meshes of other vertices may share.
  using KnownMeshes = std::unordered_multimap<const void*, std::shared_ptr<const MeshBvh>>;
  static std::shared_ptr<const MeshBvh> find(const KnownMeshes& known, std::span<const Part> parts);
  void build_meshes(const Impl* before);
  void build_mesh(const Placement& p, KnownMeshes& known);
  void take_over(const Impl& before, KnownMeshes& known);
  void find_origins();
  RTCGeometry new_copy(std::uint32_t part, const Affine* to_world);
  void attach(RTCGeometry geometry, std::uint32_t placement, std::uint32_t primitive);
  std::vector<RTCGeometry> make_instances() const;
  void build_top();
  void commit_top();
  static void set_instance_transform(RTCGeometry instance, const Affine& to_world);
  void set_area_lights(RTCGeometry quads);
  void rebind(const Scene& s, const World& w);
  void update_transforms(const Scene& s, const World& w);

  const Scene* scene;
  const World* world;
  SceneBuild build;
  std::shared_ptr<EmbreeDevice> device;
  MeshUses uses;
  BuildCounts builds;
  RTCScene top = nullptr;
  std::vector<std::shared_ptr<const MeshBvh>> meshes;  // by mesh; null where the mesh is not instanced
  std::vector<std::shared_ptr<MeshBvh>> fresh;         // while it is built: those of them that are new
  std::vector<std::shared_ptr<TracedMesh>> copies;     // by part; null where it is not in world space
  std::vector<const PairOrigin*> origins;              // by part; empty where no part is paired
  std::vector<TopEntry> entries;                       // by geometry id of the top level
  std::vector<RTCGeometry> geometries;  // by geometry id of the top level; the top-level scene owns them
  std::vector<SolidGeometry> solid_geometries;
};

}  // namespace parian
