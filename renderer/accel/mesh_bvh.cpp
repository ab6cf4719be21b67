#include "renderer/accel/mesh_bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "renderer/accel/mesh_uses.h"
#include "renderer/base/parallel.h"

namespace parian {
namespace {

bool count_bytes(void* user, ssize_t bytes, bool) {
  static_cast<std::atomic<std::ptrdiff_t>*>(user)->fetch_add(bytes);
  return true;
}

/// Told by Embree of the share done; false ends the build.
bool report_progress(void* user, double share) {
  const SceneBuild& build = *static_cast<const SceneBuild*>(user);
  if (build.settings.on_progress) build.settings.on_progress(share);
  return !build.cancelled || !build.cancelled->load(std::memory_order_relaxed);
}

}  // namespace

EmbreeDevice::EmbreeDevice() : handle(rtcNewDevice(fmt::format("threads={}", thread_count()).c_str())) {
  if (!handle) throw std::runtime_error("Embree: no device");
  rtcSetDeviceMemoryMonitorFunction(handle, count_bytes, &bytes);
}

void EmbreeDevice::check(const char* what) const {
  const RTCError error = rtcGetDeviceError(handle);
  if (error == RTC_ERROR_CANCELLED) throw BuildCancelled();
  if (error != RTC_ERROR_NONE)
    throw std::runtime_error(fmt::format("Embree: {} failed with error {}", what, int(error)));
}

RTCScene new_scene(const EmbreeDevice& device, const SceneBuild& build) {
  RTCScene result = rtcNewScene(device.handle);
  // What only media need, others do not pay for.
  rtcSetSceneFlags(result, RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | (build.visitable ? kVisitable : 0) |
                                         (build.settings.compact ? RTC_SCENE_FLAG_COMPACT : 0)));
  rtcSetSceneBuildQuality(result, build.quality());
  return result;
}

void commit_scene(const EmbreeDevice& device, RTCScene scene, const SceneBuild& build, const char* what) {
  const bool watched = build.settings.on_progress || build.cancelled;
  SceneBuild watching = build;  // what Embree is given it hands back as it may be changed
  if (watched) rtcSetSceneProgressMonitorFunction(scene, report_progress, &watching);
  rtcCommitScene(scene);
  if (watched) rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  device.check(what);
}

TracedMesh::TracedMesh(const Primitive& primitive, bool paired)
    : triangles(primitive.triangles), positions(primitive.positions) {
  if (paired) pairs = pair_triangles(triangles);
}

RTCGeometry new_geometry(const EmbreeDevice& device, const SceneBuild& build, const TracedMesh& mesh,
                         const Affine* to_world, bool filtered) {
  RTCGeometry geometry =
      rtcNewGeometry(device.handle, mesh.pairs ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
  if (mesh.pairs)
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, mesh.pairs->quads.data(),
                               0, sizeof(Quad), mesh.pairs->quads.size());
  else
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(Triangle), mesh.triangles.size());
  set_vertices(device, geometry, mesh.positions, to_world);
  if (filtered) {
    rtcSetGeometryIntersectFilterFunction(geometry, build.alpha_filter);
    rtcSetGeometryOccludedFilterFunction(geometry, build.alpha_filter);
  }
  rtcSetGeometryBuildQuality(geometry, build.quality());
  rtcCommitGeometry(geometry);
  return geometry;
}

void set_vertices(const EmbreeDevice& device, RTCGeometry geometry, const SharedArray<Vec3f>& positions,
                  const Affine* to_world) {
  // Embree reads 16 bytes at the last vertex, so memory that was not laid out for it is copied.
  if (!copies_vertices(positions, to_world)) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                               sizeof(Vec3f), positions.size());
    return;
  }
  auto* out = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), positions.size()));
  device.check("allocating vertices");
  parallel_chunks(positions.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      out[i] = to_world ? to_world->point(positions[i]) : positions[i];
  });
}

MeshBvh::MeshBvh(std::shared_ptr<EmbreeDevice> device, const SceneBuild& build, std::span<const Part> parts,
                 bool paired)
    : device_(std::move(device)), quality_(build.settings.quality) {
  for (const Part& part : parts) {
    build.poll();
    parts_.push_back(std::make_shared<TracedMesh>(*part.primitive, paired));
  }
  build_scene(build, parts);
}

MeshBvh::MeshBvh(const MeshBvh& mesh, const SceneBuild& build)
    : device_(mesh.device_), parts_(mesh.parts_), quality_(build.settings.quality) {
  build_scene(build, {});
}

void MeshBvh::build_scene(const SceneBuild& build, std::span<const Part> parts) {
  scene_ = new_scene(*device_, build);
  try {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      const bool filtered = build.settings.editable || parts[i].alpha;
      RTCGeometry geometry = new_geometry(*device_, build, *parts_[i], nullptr, filtered);
      rtcAttachGeometryByID(scene_, geometry, unsigned(i));
      rtcReleaseGeometry(geometry);
    }
    commit_scene(*device_, scene_, build, "building a mesh");
  } catch (...) {
    rtcReleaseScene(scene_);
    throw;
  }
}

bool MeshBvh::holds(std::span<const Part> parts) const {
  const auto same = [](const auto& a, const auto& b) { return a.data() == b.data() && a.size() == b.size(); };
  return std::ranges::equal(parts_, parts, [&](const std::shared_ptr<TracedMesh>& mine, const Part& part) {
    return same(mine->triangles, part.primitive->triangles) &&
           same(mine->positions, part.primitive->positions);
  });
}

void MeshBvh::add_origins() {
  for (const auto& part : parts_) part->add_origins();
}

}  // namespace parian
