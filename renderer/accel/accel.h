/// The ray queries, and the only code that knows Embree. A mesh that is drawn once goes into the top-level
/// BVH in world space; a mesh drawn more often, or every mesh where the scene is to be edited, has a BVH of
/// its own that is instanced. What a scene lacks (instances, alpha, area lights) is not in its BVH and costs
/// its rays nothing.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "renderer/scene/surface.h"

namespace parian {

/// How well the BVH is built, against the time and memory that takes: by Morton codes; by the surface area
/// heuristic; by that, with meshes that are drawn a few times copied into world space instead of instanced.
/// The same picture. (Embree's own high quality does nothing in robust mode: docs/large.md.)
enum class BuildQuality : std::uint8_t { fast, balanced, best };

struct AccelSettings {
  // Instance every mesh, so that an edit builds what it brings and the top level. Alpha may come and go.
  bool editable = false;
  BuildQuality quality = BuildQuality::balanced;
  bool compact = false;  // half of the memory, for rays that take longer
  // Told the share done, 0 to 1, of the mesh or the scene that is being built, from any thread; may be empty.
  std::function<void(double)> on_progress{};
};

/// Bytes, at the end and while the BVH is built.
struct AccelMemory {
  std::size_t held = 0, peak = 0;
};

/// Triangles that BuildQuality::best copies, each as often as it is drawn.
double copied_triangles(const Scene& scene, const World& world);

/// What an Accel of the world will take, beside the scene: within some percent, found in some milliseconds.
AccelMemory estimate_memory(const Scene& scene, const World& world, const AccelSettings& settings);

/// What the builds of an Accel's life were, that of those before it included: an edit must not cause more
/// than it needs.
struct BuildCounts {
  int meshes = 0;     // primitives put into BVHs of meshes, or copied into world space
  int refined = 0;    // BVHs of a mesh that were built again, better
  int top_level = 0;  // commits of the top-level scene
};

/// Thrown by a build that was told to end.
struct BuildCancelled : std::runtime_error {
  BuildCancelled() : std::runtime_error("the build was cancelled") {}
};

class MeshBvh;

/// Up to 16 rays that are traced together, each with the number that decides stochastic alpha.
struct alignas(64) RayPacket {
  static constexpr int kSize = 16;
  float ox[kSize]{}, oy[kSize]{}, oz[kSize]{}, dx[kSize]{}, dy[kSize]{}, dz[kSize]{}, tmax[kSize]{};
  std::uint32_t random[kSize]{};
  int count = 0;

  void add(const Ray& ray, std::uint32_t number) {
    ox[count] = ray.o.x;
    oy[count] = ray.o.y;
    oz[count] = ray.o.z;
    dx[count] = ray.d.x;
    dy[count] = ray.d.y;
    dz[count] = ray.d.z;
    tmax[count] = ray.tmax;
    random[count++] = number;
  }
  Ray ray(int i) const { return {{ox[i], oy[i], oz[i]}, {dx[i], dy[i], dz[i]}, tmax[i]}; }
};

/// The surface of one medium in one place: what of the placement or solid that a hit names bounds it.
struct Body {
  std::uint32_t placement;
  std::int32_t medium;  // of World::media
};

class Accel {
 public:
  /// The scene and world must outlive the Accel. Throws std::runtime_error where Embree fails (out of
  /// memory). `before`: one of a scene to be edited, with the same settings, whose BVHs of meshes are taken
  /// over where the arrays are the same, those in no use included while the scene has the mesh; it stays as
  /// it is, to be traced on. `cancelled`: throws BuildCancelled soon after it is set.
  Accel(const Scene& scene, const World& world, const AccelSettings& settings, const Accel* before = nullptr,
        const std::atomic<bool>* cancelled = nullptr);
  ~Accel();
  Accel(const Accel&) = delete;
  Accel& operator=(const Accel&) = delete;

  /// Follows an edit that left meshes, the number of placements and area lights and, unless editable,
  /// materials' alpha as they were, and moved placements or area lights. `scene` and `world` replace those
  /// given before.
  void update_transforms(const Scene& scene, const World& world);
  /// Points to a scene and world that differ from those given before in nothing that the BVH holds.
  void rebind(const Scene& scene, const World& world);

  /// Nearest hit of the ray, if any (else hit.placement is kMiss); rays of unit direction. `random` decides
  /// stochastic alpha.
  bool intersect(const Ray& ray, std::uint32_t random, Hit& hit) const;
  /// Whether anything lies in (0, tmax) of the ray, whose direction need not be of unit length.
  bool occluded(const Ray& ray, std::uint32_t random) const;

  /// The same for a packet of one ray at least; far cheaper than one by one where the rays run along each
  /// other, as the camera rays of neighbouring pixels do. A hit may depend on the other rays within rounding,
  /// so who wants the same bits again asks for the same rays together.
  void intersect(const RayPacket& rays, std::array<Hit, RayPacket::kSize>& hits) const;
  /// The same; bit i says that ray i is blocked. Cheaper where they end in one place, as shadow rays to a
  /// lamp do.
  std::uint32_t occluded(const RayPacket& rays) const;

  /// Everything that a ray of any direction crosses in (0, tmax), in no order, each surface at each place
  /// once; or, where a body is given, its surface alone. Returns how many there are and puts them into
  /// `hits`: where there is no room for all, as many as there is, each as likely as any other. For worlds
  /// that have media; others are not built for it.
  std::size_t crossings(const Ray& ray, std::uint32_t random, std::span<Hit> hits,
                        const Body* body = nullptr) const;

  /// Large meshes of a scene to be edited are built quickly first. These are the better BVHs of up to
  /// `threads` threads' work, to be built beside tracing, and put in their places between; empty where there
  /// is nothing to do. Pictures do not depend on it but where a ray meets two triangles at once
  /// (docs/editor.md). Throws as the constructor.
  using Refined = std::vector<std::shared_ptr<const MeshBvh>>;
  bool can_refine() const;
  Refined refine(int threads, const std::atomic<bool>& cancelled) const;
  /// Not beside tracing. Those of meshes that are there no longer are dropped.
  void adopt(const Refined& refined);

  std::size_t bytes() const;  // what it holds now
  BuildCounts builds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parian
