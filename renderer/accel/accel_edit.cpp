/// How an Accel follows edits, and what of it is there.
#include <algorithm>
#include <set>

#include "renderer/accel/accel_impl.h"
#include "renderer/base/memory.h"
#include "renderer/base/parallel.h"

namespace parian {
namespace {

/// Whether there is memory for the mesh's BVH once more, and for building it.
bool fits(const MeshBvh& mesh) {
  constexpr double kBytes = 100;  // for a triangle, at most (docs/large.md)
  double triangles = 0;
  for (const auto& part : mesh.parts()) triangles += double(part->triangles.size());
  return double(resident_memory()) + kBytes * triangles <= double(memory_limit());
}

}  // namespace

Accel::Accel(const Scene& scene, const World& world, const AccelSettings& settings, const Accel* before,
             const std::atomic<bool>* cancelled)
    : impl_(std::make_unique<Impl>(scene, world, settings, before ? before->impl_.get() : nullptr,
                                   cancelled)) {}

Accel::~Accel() = default;

void Accel::Impl::rebind(const Scene& s, const World& w) {
  scene = &s;
  world = &w;
  // Filters hold pointers into the world.
  for (std::size_t id = 0; id < entries.size(); ++id) {
    const auto [placement, primitive] = entries[id];
    if (placement == Hit::kAreaLightHit)
      set_area_lights(geometries[id]);
    else if (placement == Hit::kSolid)
      solid_geometries[primitive].world = &w;
  }
}

void Accel::Impl::update_transforms(const Scene& s, const World& w) {
  std::vector<Affine> old;
  for (const Placement& p : world->placements) old.push_back(p.to_world);
  rebind(s, w);
  for (std::size_t id = 0; id < entries.size(); ++id) {
    const auto [placement, primitive] = entries[id];
    if (placement == Hit::kAreaLightHit) continue;
    RTCGeometry geometry = geometries[id];
    if (placement == Hit::kSolid) {
      fill_solids(solid_geometries[primitive], w);
      rtcCommitGeometry(geometry);
      continue;
    }
    const Placement& p = w.placements[placement];
    if (old[placement] == p.to_world) continue;
    if (meshes[p.mesh]) {
      set_instance_transform(geometry, p.to_world);
    } else {
      set_vertices(*device, geometry, w.part(placement, primitive).primitive->positions, &p.to_world);
      rtcCommitGeometry(geometry);
      ++builds.meshes;
    }
  }
  commit_top();
}

void Accel::rebind(const Scene& scene, const World& world) { impl_->rebind(scene, world); }

void Accel::update_transforms(const Scene& scene, const World& world) {
  impl_->update_transforms(scene, world);
}

bool Accel::can_refine() const {
  return std::ranges::any_of(impl_->meshes, [&](const auto& mesh) {
    return mesh && mesh->quality() != impl_->build.settings.quality;
  });
}

Accel::Refined Accel::refine(int threads, const std::atomic<bool>& cancelled) const {
  Refined refined;
  SceneBuild build = impl_->build;
  build.settings.on_progress = nullptr;
  build.cancelled = &cancelled;
  std::set<const MeshBvh*> seen;
  for (const auto& mesh : impl_->meshes) {
    if (!mesh || mesh->quality() == build.settings.quality || !seen.insert(mesh.get()).second) continue;
    if (!fits(*mesh)) continue;
    build.poll();
    run_on_threads(threads, [&] { refined.push_back(std::make_shared<const MeshBvh>(*mesh, build)); });
  }
  return refined;
}

void Accel::adopt(const Refined& refined) {
  std::vector<bool> changed(impl_->meshes.size(), false);
  for (const auto& better : refined) {
    bool used = false;
    for (std::size_t i = 0; i < changed.size(); ++i) {
      auto& mesh = impl_->meshes[i];
      if (!mesh || mesh == better || mesh->parts() != better->parts()) continue;
      mesh = better;
      changed[i] = used = true;
    }
    impl_->builds.refined += used;
  }
  if (std::ranges::none_of(changed, [](bool c) { return c; })) return;
  for (std::size_t id = 0; id < impl_->entries.size(); ++id) {
    const std::uint32_t placement = impl_->entries[id].placement;
    if (placement >= Hit::kSolid) continue;  // not a mesh
    const int mesh = impl_->world->placements[placement].mesh;
    if (!changed[std::size_t(mesh)]) continue;
    rtcSetGeometryInstancedScene(impl_->geometries[id], impl_->meshes[std::size_t(mesh)]->scene());
    rtcCommitGeometry(impl_->geometries[id]);
  }
  impl_->commit_top();
}

std::size_t Accel::bytes() const {
  std::size_t bytes = std::size_t(std::max<std::ptrdiff_t>(0, impl_->device->bytes.load()));
  std::set<const TracedMesh*> seen;
  const auto add = [&](const std::shared_ptr<TracedMesh>& part) {
    if (part && part->pairs && seen.insert(part.get()).second) bytes += part->pairs->bytes();
  };
  for (const auto& part : impl_->copies) add(part);
  for (const auto& mesh : impl_->meshes)
    if (mesh)
      for (const auto& part : mesh->parts()) add(part);
  return bytes;
}

BuildCounts Accel::builds() const { return impl_->builds; }

}  // namespace parian
