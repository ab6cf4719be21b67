/// How an Accel is built.
#include <algorithm>

#include "renderer/accel/accel_impl.h"
#include "renderer/base/parallel.h"

namespace parian {
namespace {

/// Cuts the disk out of its quad.
void disk_filter(const RTCFilterFunctionNArguments* a) {
  const auto* lights = static_cast<const std::vector<AreaLight>*>(a->geometryUserPtr);
  filter_hits(a, [&](unsigned i) {
    if (!(*lights)[RTCHitN_primID(a->hit, a->N, i)].disk) return true;
    const float x = RTCHitN_u(a->hit, a->N, i) - 0.5f, y = RTCHitN_v(a->hit, a->N, i) - 0.5f;
    return x * x + y * y <= 0.25f;
  });
}

}  // namespace

/// Turns a hit away with probability 1 - coverage. The choice is a hash of the ray and the triangle, so that
/// a triangle met twice by one ray decides alike.
void Accel::Impl::alpha_filter(const RTCFilterFunctionNArguments* a) {
  const auto& query = *static_cast<const Query*>(a->context);
  const Impl& accel = *static_cast<const Impl*>(query.accel);
  filter_hits(a, [&](unsigned i) {
    const std::uint32_t top = RTCHitN_instID(a->hit, a->N, i, 0);
    const std::uint32_t geometry = RTCHitN_geomID(a->hit, a->N, i);
    const TopEntry& entry = accel.entries[top != kInvalidId ? top : geometry];
    const std::uint32_t primitive = top != kInvalidId ? geometry : entry.primitive;
    const Part& part = accel.world->part(entry.placement, primitive);
    if (!part.alpha) return true;
    const TrianglePoint p = accel.point(entry.placement, primitive, RTCHitN_primID(a->hit, a->N, i),
                                        RTCHitN_u(a->hit, a->N, i), RTCHitN_v(a->hit, a->N, i));
    const float coverage = eval_coverage(*query.scene, part, p.triangle, p.u, p.v);
    const std::uint32_t where = hash32(p.triangle, hash32(geometry, top));
    return query.meets(RTCRayN_id(a->ray, a->N, i), where, coverage);
  });
}

/// Keeps every hit that Embree shows, and lets it look on.
void Accel::Impl::collect(const RTCFilterFunctionNArguments* a) {
  const auto& query = *static_cast<const Query*>(a->context);
  const Impl& accel = *static_cast<const Impl*>(query.accel);
  filter_hits(a, [&](unsigned i) {
    query.crossings->add(accel.to_hit(RTCRayN_tfar(a->ray, a->N, i), RTCHitN_u(a->hit, a->N, i),
                                      RTCHitN_v(a->hit, a->N, i), RTCHitN_instID(a->hit, a->N, i, 0),
                                      RTCHitN_geomID(a->hit, a->N, i), RTCHitN_primID(a->hit, a->N, i),
                                      [] { return Vec3f(0); }));
    return false;
  });
}

Accel::Impl::Impl(const Scene& s, const World& w, const AccelSettings& settings, const Impl* before,
                  const std::atomic<bool>* cancelled)
    : scene(&s),
      world(&w),
      // A medium may come with an edit, so scenes to be edited are built for them.
      build{settings, settings.editable || !w.media.empty(), cancelled, alpha_filter},
      device(before ? before->device : std::make_shared<EmbreeDevice>()),
      uses(find_mesh_uses(s, w, settings)),
      builds(before ? before->builds : BuildCounts()),
      copies(w.parts.size()) {
  top = new_scene(*device, build);
  try {
    build_meshes(before);
    build_top();
  } catch (...) {
    rtcReleaseScene(top);
    throw;
  }
  find_origins();
  build.cancelled = nullptr;
}

void Accel::Impl::build_meshes(const Impl* before) {
  meshes.assign(uses.instanced.size(), nullptr);
  KnownMeshes known;
  if (before) take_over(*before, known);
  for (const Placement& p : world->placements)
    if (!meshes[p.mesh] && uses.instanced[p.mesh]) build_mesh(p, known);
}

std::shared_ptr<const MeshBvh> Accel::Impl::find(const KnownMeshes& known, std::span<const Part> parts) {
  const auto [first, last] = known.equal_range(parts[0].primitive->triangles.data());
  const auto found = std::find_if(first, last, [&](const auto& entry) { return entry.second->holds(parts); });
  return found == last ? nullptr : found->second;
}

/// Also of meshes that are not drawn now, so that what is hidden comes back at once.
void Accel::Impl::take_over(const Impl& before, KnownMeshes& known) {
  for (const auto& mesh : before.meshes)
    if (mesh && !mesh->parts().empty()) known.emplace(mesh->parts()[0]->triangles.data(), mesh);
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const auto count = std::uint32_t(world->mesh(*scene, int(i)).primitives.size());
    const std::span<const Part> parts = std::span(world->parts).subspan(first, count);
    first += count;
    if (parts.empty()) continue;
    meshes[i] = find(known, parts);
  }
}

void Accel::Impl::build_mesh(const Placement& p, KnownMeshes& known) {
  const std::span<const Part> parts = parts_of(p);
  build.poll();
  // Another mesh may be of the same arrays, and have the same filters.
  if (build.settings.editable && !parts.empty())
    if (auto same = find(known, parts)) {
      meshes[p.mesh] = std::move(same);
      return;
    }
  SceneBuild this_build = build;
  this_build.settings.quality = first_quality(parts, build.settings);
  const bool paired = build.settings.editable ? pays_to_pair(parts) : uses.paired;
  fresh.push_back(std::make_shared<MeshBvh>(device, this_build, parts, paired));
  meshes[p.mesh] = fresh.back();
  if (!parts.empty()) known.emplace(parts[0].primitive->triangles.data(), fresh.back());
  builds.meshes += int(parts.size());
}

/// The way back to the triangles, which takes memory that the builds are better off with.
void Accel::Impl::find_origins() {
  for (const auto& mesh : fresh) mesh->add_origins();
  fresh.clear();
  bool any = false;
  std::vector<const PairOrigin*> found(world->parts.size(), nullptr);
  for (const Placement& p : world->placements)
    for (std::uint32_t i = 0; i < p.part_count; ++i) {
      const PairOrigin*& part = found[p.first_part + i];
      if (part) continue;
      TracedMesh* copy = copies[p.first_part + i].get();
      if (copy && copy->pairs && copy->pairs->origins.empty()) copy->add_origins();
      part = meshes[p.mesh] ? meshes[p.mesh]->parts()[i]->origins() : copy->origins();
      any |= part != nullptr;
    }
  if (any) origins = std::move(found);
}

RTCGeometry Accel::Impl::new_copy(std::uint32_t part, const Affine* to_world) {
  const Part& p = world->parts[part];
  // The pairs once for all copies.
  if (!copies[part]) copies[part] = std::make_shared<TracedMesh>(*p.primitive, uses.paired);
  ++builds.meshes;
  return new_geometry(*device, build, *copies[part], to_world, p.alpha);
}

void Accel::Impl::attach(RTCGeometry geometry, std::uint32_t placement, std::uint32_t primitive) {
  rtcAttachGeometryByID(top, geometry, unsigned(entries.size()));
  rtcReleaseGeometry(geometry);
  entries.push_back({placement, primitive});
  geometries.push_back(geometry);
}

/// By placement; null where the mesh is not instanced. Millions, so in parallel.
std::vector<RTCGeometry> Accel::Impl::make_instances() const {
  std::vector<RTCGeometry> instances(world->placements.size(), nullptr);
  constexpr std::size_t kGrain = 256;
  parallel_for(instances.size(), kGrain, [&](std::size_t i) {
    const Placement& p = world->placements[i];
    if (!meshes[p.mesh]) return;
    instances[i] = rtcNewGeometry(device->handle, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instances[i], meshes[p.mesh]->scene());
    set_instance_transform(instances[i], p.to_world);
  });
  return instances;
}

void Accel::Impl::build_top() {
  const std::vector<RTCGeometry> instances = make_instances();
  for (std::uint32_t i = 0; i < world->placements.size(); ++i) {
    const Placement& p = world->placements[i];
    if (instances[i]) {
      attach(instances[i], i, 0);
    } else {
      for (std::uint32_t k = 0; k < p.part_count; ++k)
        attach(new_copy(p.first_part + k, p.identity ? nullptr : &p.to_world), i, k);
    }
  }
  if (!world->area_lights.empty()) {
    const std::size_t count = world->area_lights.size();
    RTCGeometry quads = rtcNewGeometry(device->handle, RTC_GEOMETRY_TYPE_QUAD);
    rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), 4 * count);
    auto* indices = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        quads, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 4 * sizeof(std::uint32_t), count));
    for (std::uint32_t i = 0; i < 4 * count; ++i) indices[i] = i;
    set_area_lights(quads);
    attach(quads, Hit::kAreaLightHit, 0);
  }
  solid_geometries = sort_solids(*world);
  for (std::uint32_t i = 0; i < solid_geometries.size(); ++i) {
    RTCGeometry geometry = new_solid_geometry(device->handle, solid_geometries[i]);
    rtcCommitGeometry(geometry);
    attach(geometry, Hit::kSolid, i);
  }
  commit_top();
}

void Accel::Impl::commit_top() {
  commit_scene(*device, top, build, "building the scene");
  ++builds.top_level;
}

void Accel::Impl::set_instance_transform(RTCGeometry instance, const Affine& to_world) {
  rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &to_world);
  rtcCommitGeometry(instance);
}

void Accel::Impl::set_area_lights(RTCGeometry quads) {
  auto* vertices = static_cast<Vec3f*>(rtcGetGeometryBufferData(quads, RTC_BUFFER_TYPE_VERTEX, 0));
  bool disks = false;
  for (std::size_t i = 0; i < world->area_lights.size(); ++i) {
    const AreaLight& light = world->area_lights[i];
    vertices[4 * i + 0] = light.center - light.half_x - light.half_y;
    vertices[4 * i + 1] = light.center + light.half_x - light.half_y;
    vertices[4 * i + 2] = light.center + light.half_x + light.half_y;
    vertices[4 * i + 3] = light.center - light.half_x + light.half_y;
    disks |= light.disk;
  }
  rtcSetGeometryUserData(quads, const_cast<void*>(static_cast<const void*>(&world->area_lights)));
  rtcSetGeometryIntersectFilterFunction(quads, disks ? disk_filter : nullptr);
  rtcSetGeometryOccludedFilterFunction(quads, disks ? disk_filter : nullptr);
  rtcUpdateGeometryBuffer(quads, RTC_BUFFER_TYPE_VERTEX, 0);
  rtcCommitGeometry(quads);
}

}  // namespace parian
