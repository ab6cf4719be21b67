/// A mesh as Embree traces it: its arrays, its triangles in pairs, its BVH. Nothing of it changes once it is
/// built, so that an edited scene takes over those of the meshes that it did not touch.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/accel/accel.h"
#include "renderer/accel/embree.h"
#include "renderer/accel/triangle_pairs.h"

namespace parian {

/// An Embree device and what it holds; shared by all that was built on it.
struct EmbreeDevice {
  EmbreeDevice();
  ~EmbreeDevice() { rtcReleaseDevice(handle); }
  EmbreeDevice(const EmbreeDevice&) = delete;
  EmbreeDevice& operator=(const EmbreeDevice&) = delete;

  /// Throws what the last call on this thread failed with: BuildCancelled, or std::runtime_error.
  void check(const char* what) const;

  RTCDevice handle = nullptr;
  std::atomic<std::ptrdiff_t> bytes{0};
};

/// How scenes are built, and who is told.
struct SceneBuild {
  AccelSettings settings;
  bool visitable = false;                        // embree_visit() may ask
  const std::atomic<bool>* cancelled = nullptr;  // asked while Embree builds; may be null
  RTCFilterFunctionN alpha_filter = nullptr;     // asked about hits on what is not opaque

  RTCBuildQuality quality() const {
    return settings.quality == BuildQuality::fast ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
  }
  /// Throws BuildCancelled where that is asked for.
  void poll() const {
    if (cancelled && cancelled->load(std::memory_order_relaxed)) throw BuildCancelled();
  }
};

/// An empty scene. Robust: without it rays slip through shared edges.
RTCScene new_scene(const EmbreeDevice& device, const SceneBuild& build);
/// Commits the scene. Throws as EmbreeDevice::check().
void commit_scene(const EmbreeDevice& device, RTCScene scene, const SceneBuild& build, const char* what);

/// What Embree reads of a primitive while its geometry lives, and what takes a hit back to a triangle. The
/// scene may be replaced by an edited one, so the arrays are held here.
struct TracedMesh {
  SharedArray<Triangle> triangles;
  SharedArray<Vec3f> positions;
  std::optional<TrianglePairs> pairs;  // absent: Embree has the triangles themselves

  TracedMesh(const Primitive& primitive, bool paired);
  void add_origins() {
    if (pairs) find_origins(*pairs, triangles);
  }
  const PairOrigin* origins() const { return pairs ? pairs->origins.data() : nullptr; }
};

/// The geometry of a mesh, committed, with the vertices in world space where `to_world` is given; with the
/// alpha filter if `filtered`.
RTCGeometry new_geometry(const EmbreeDevice& device, const SceneBuild& build, const TracedMesh& mesh,
                         const Affine* to_world, bool filtered);

/// Gives the geometry the vertices.
void set_vertices(const EmbreeDevice& device, RTCGeometry geometry, const SharedArray<Vec3f>& positions,
                  const Affine* to_world);

/// The BVH of a mesh in its own space, to be instanced.
class MeshBvh {
 public:
  /// Of a scene to be edited all parts are filtered: which are opaque may change. Throws as
  /// EmbreeDevice::check().
  MeshBvh(std::shared_ptr<EmbreeDevice> device, const SceneBuild& build, std::span<const Part> parts,
          bool paired);
  /// The same mesh of a scene to be edited, built anew.
  MeshBvh(const MeshBvh& mesh, const SceneBuild& build);
  ~MeshBvh() { rtcReleaseScene(scene_); }
  MeshBvh& operator=(const MeshBvh&) = delete;

  RTCScene scene() const { return scene_; }
  const std::vector<std::shared_ptr<TracedMesh>>& parts() const { return parts_; }
  BuildQuality quality() const { return quality_; }
  /// Whether it is that of these parts: their arrays are the very ones.
  bool holds(std::span<const Part> parts) const;
  /// Adds the way back from pairs to triangles, which takes memory that a build is better off with.
  void add_origins();

 private:
  void build_scene(const SceneBuild& build, std::span<const Part> parts);

  std::shared_ptr<EmbreeDevice> device_;
  std::vector<std::shared_ptr<TracedMesh>> parts_;
  BuildQuality quality_;
  RTCScene scene_ = nullptr;
};

}  // namespace parian
