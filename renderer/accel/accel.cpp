/// The queries: rays to Embree, and hits back.
#include "renderer/accel/accel.h"

#include <algorithm>
#include <cassert>

#include "renderer/accel/accel_impl.h"

namespace parian {
namespace {

void set_ray(RTCRay& r, const Ray& ray) {
  r.org_x = ray.o.x;
  r.org_y = ray.o.y;
  r.org_z = ray.o.z;
  r.dir_x = ray.d.x;
  r.dir_y = ray.d.y;
  r.dir_z = ray.d.z;
  r.tnear = 0;
  r.tfar = ray.tmax;
  r.time = 0;
  r.mask = 0xffffffffu;
  r.id = 0;
  r.flags = 0;
}

struct Lanes {
  alignas(64) int valid[RayPacket::kSize];
};

/// Returns which lanes hold a ray.
Lanes set_rays(RTCRay16& r, const RayPacket& rays) {
  assert(0 < rays.count && rays.count <= RayPacket::kSize);
  Lanes lanes;
  for (int i = 0; i < RayPacket::kSize; ++i) {
    lanes.valid[i] = i < rays.count ? -1 : 0;
    r.tnear[i] = 0;
    r.time[i] = 0;
    r.mask[i] = 0xffffffffu;
    r.id[i] = unsigned(i);
    r.flags[i] = 0;
  }
  // Lanes without a ray repeat the first one: Embree looks at them, and takes longer where they hold another.
  const auto set = [&](float* to, const float* from) {
    std::copy_n(from, RayPacket::kSize, to);
    for (int i = rays.count; i < RayPacket::kSize; ++i) to[i] = from[0];
  };
  set(r.org_x, rays.ox);
  set(r.org_y, rays.oy);
  set(r.org_z, rays.oz);
  set(r.dir_x, rays.dx);
  set(r.dir_y, rays.dy);
  set(r.dir_z, rays.dz);
  set(r.tfar, rays.tmax);
  return lanes;
}

}  // namespace

<<<<<<< HEAD
struct Accel::Impl {
  // A top-level geometry id means: a primitive in world space, an instance of a mesh, all area lights, or
  // (placement kSolid) the solids of solid_geometries[primitive].
  struct TopEntry {
    std::uint32_t placement, primitive;
  };

  const Scene* scene;
  const World* world;
  AccelSettings settings;
  MeshUses uses;
  std::atomic<std::ptrdiff_t> bytes{0};
  BuildCounts builds;
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  std::vector<RTCScene> mesh_scenes;    // by mesh; null where the mesh is not instanced
  std::vector<TopEntry> entries;        // by geometry id of the top level
  std::vector<TracedMesh> traced;       // by part
  std::vector<RTCGeometry> geometries;  // by geometry id of the top level; the top-level scene owns them
  std::vector<SolidGeometry> solid_geometries;

  Impl(const Scene& s, const World& w, const AccelSettings& a)
      : scene(&s), world(&w), settings(a), uses(find_mesh_uses(s, w, a)), traced(w.parts.size()) {
    device = rtcNewDevice(fmt::format("threads={}", thread_count()).c_str());
    if (!device) throw std::runtime_error("Embree: no device");
    rtcSetDeviceMemoryMonitorFunction(device, memory_monitor, &bytes);
    top = new_scene();
    build_meshes();
    build_top();
    for (TracedMesh& mesh : traced)
      if (mesh.pairs) find_origins(*mesh.pairs, mesh.triangles);
  }

  ~Impl() {
    for (RTCScene mesh : mesh_scenes)
      if (mesh) rtcReleaseScene(mesh);
    if (top) rtcReleaseScene(top);
    if (device) rtcReleaseDevice(device);
  }

  RTCBuildQuality quality() const {
    return settings.quality == BuildQuality::fast ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
  }

  static bool report_progress(void* user, double share) {
    static_cast<const AccelSettings*>(user)->on_progress(share);
    return true;
  }

  /// Robust: without it rays slip through shared edges.
  RTCScene new_scene() const {
    RTCScene result = rtcNewScene(device);
    // What only media need, others do not pay for.
    rtcSetSceneFlags(result, RTCSceneFlags(RTC_SCENE_FLAG_ROBUST | (world->media.empty() ? 0 : kVisitable) |
                                           (settings.compact ? RTC_SCENE_FLAG_COMPACT : 0)));
    rtcSetSceneBuildQuality(result, quality());
    if (settings.on_progress)
      rtcSetSceneProgressMonitorFunction(result, report_progress, const_cast<AccelSettings*>(&settings));
    return result;
  }

  void check(const char* what) const {
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
      throw std::runtime_error(fmt::format("Embree: {} failed with error {}", what, int(error)));
  }

  /// `normal()` is what Embree reports as the normal.
  template <class Normal>
  Hit to_hit(float t, float u, float v, unsigned instance, unsigned geometry, unsigned triangle,
             const Normal& normal) const {
    if (geometry == kInvalid) return {t, u, v, Hit::kMiss, 0, 0, 0};
    const bool instanced = instance != kInvalid;
    const TopEntry& entry = entries[instanced ? instance : geometry];
    if (entry.placement == Hit::kSolid) [[unlikely]]
      return to_solid_hit(solid_geometries[entry.primitive], t, triangle, u, normal());
    const std::uint32_t primitive = instanced ? geometry : entry.primitive;
    if (!uses.paired || entry.placement == Hit::kAreaLightHit)
      return {t, u, v, entry.placement, primitive, triangle, 0};
    const TrianglePoint p =
        traced[world->placements[entry.placement].first_part + primitive].point(triangle, u, v);
    return {t, p.u, p.v, entry.placement, primitive, p.triangle, 0};
  }

  /// Keeps every hit that Embree shows, and lets it look on.
  static void collect(const RTCFilterFunctionNArguments* a) {
    Crossings& crossings = *static_cast<const Query*>(a->context)->crossings;
    const Impl& accel = *static_cast<const Impl*>(crossings.accel);
    filter_hits(a, [&](unsigned i) {
      crossings.add(accel.to_hit(RTCRayN_tfar(a->ray, a->N, i), RTCHitN_u(a->hit, a->N, i),
                                 RTCHitN_v(a->hit, a->N, i), RTCHitN_instID(a->hit, a->N, i, 0),
                                 RTCHitN_geomID(a->hit, a->N, i), RTCHitN_primID(a->hit, a->N, i),
                                 [] { return Vec3f(0); }));
      return false;
    });
  }

  RTCGeometry new_mesh(std::uint32_t part, const Affine* to_world) {
    TracedMesh& mesh = traced[part];
    mesh.part = &world->parts[part];
    mesh.triangles = mesh.part->primitive->triangles;
    mesh.positions = mesh.part->primitive->positions;
    if (uses.paired && !mesh.pairs) mesh.pairs = pair_triangles(mesh.triangles);  // once for all copies
    RTCGeometry geometry =
        rtcNewGeometry(device, mesh.pairs ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
    if (mesh.pairs)
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                 mesh.pairs->quads.data(), 0, sizeof(Quad), mesh.pairs->quads.size());
    else
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(),
                                 0, sizeof(Triangle), mesh.triangles.size());
    set_vertices(geometry, mesh.positions, to_world);
    rtcSetGeometryUserData(geometry, &mesh);
    if (mesh.part->alpha) {
      rtcSetGeometryIntersectFilterFunction(geometry, alpha_filter);
      rtcSetGeometryOccludedFilterFunction(geometry, alpha_filter);
    }
    rtcSetGeometryBuildQuality(geometry, quality());
    rtcCommitGeometry(geometry);
    ++builds.meshes;
    return geometry;
  }

  /// Embree reads 16 bytes at the last vertex, so memory that was not laid out for it is copied.
  void set_vertices(RTCGeometry geometry, const SharedArray<Vec3f>& positions, const Affine* to_world) {
    if (!copies_vertices(positions, to_world))
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                                 sizeof(Vec3f), positions.size());
    else
      fill_vertices(geometry, positions, to_world);
  }

  void fill_vertices(RTCGeometry geometry, const SharedArray<Vec3f>& positions, const Affine* to_world) {
    auto* out = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), positions.size()));
    check("allocating vertices");
    parallel_chunks(positions.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        out[i] = to_world ? to_world->point(positions[i]) : positions[i];
    });
  }

  void build_meshes() {
    mesh_scenes.assign(uses.instanced.size(), nullptr);
    for (const Placement& p : world->placements) {
      if (mesh_scenes[p.mesh] || !uses.instanced[p.mesh]) continue;
      RTCScene mesh = new_scene();
      for (std::uint32_t i = 0; i < p.part_count; ++i) {
        RTCGeometry geometry = new_mesh(p.first_part + i, nullptr);
        rtcAttachGeometryByID(mesh, geometry, i);
        rtcReleaseGeometry(geometry);
      }
      rtcCommitScene(mesh);
      check("building a mesh");
      mesh_scenes[p.mesh] = mesh;
    }
  }

  void attach(RTCGeometry geometry, std::uint32_t placement, std::uint32_t primitive) {
    rtcAttachGeometryByID(top, geometry, unsigned(entries.size()));
    rtcReleaseGeometry(geometry);
    entries.push_back({placement, primitive});
    geometries.push_back(geometry);
  }

  /// By placement; null where the mesh is not instanced. Millions, so in parallel.
  std::vector<RTCGeometry> make_instances() const {
    std::vector<RTCGeometry> instances(world->placements.size(), nullptr);
    constexpr std::size_t kGrain = 256;
    parallel_for(instances.size(), kGrain, [&](std::size_t i) {
      const Placement& p = world->placements[i];
      if (!mesh_scenes[p.mesh]) return;
      instances[i] = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instances[i], mesh_scenes[p.mesh]);
      set_instance_transform(instances[i], p.to_world);
    });
    return instances;
  }

  void build_top() {
    const std::vector<RTCGeometry> instances = make_instances();
    for (std::uint32_t i = 0; i < world->placements.size(); ++i) {
      const Placement& p = world->placements[i];
      if (instances[i]) {
        attach(instances[i], i, 0);
      } else {
        for (std::uint32_t k = 0; k < p.part_count; ++k)
          attach(new_mesh(p.first_part + k, p.identity ? nullptr : &p.to_world), i, k);
      }
    }
    if (!world->area_lights.empty()) {
      RTCGeometry quads = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
      rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                              4 * world->area_lights.size());
      auto* indices = static_cast<std::uint32_t*>(
          rtcSetNewGeometryBuffer(quads, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                  4 * sizeof(std::uint32_t), world->area_lights.size()));
      for (std::uint32_t i = 0; i < 4 * world->area_lights.size(); ++i) indices[i] = i;
      set_area_lights(quads);
      attach(quads, Hit::kAreaLightHit, 0);
    }
    solid_geometries = sort_solids(*world);
    for (std::uint32_t i = 0; i < solid_geometries.size(); ++i) {
      RTCGeometry geometry = new_solid_geometry(device, solid_geometries[i]);
      rtcCommitGeometry(geometry);
      attach(geometry, Hit::kSolid, i);
    }
    commit_top();
  }

  void commit_top() {
    rtcCommitScene(top);
    check("building the scene");
    ++builds.top_level;
  }

  static void set_instance_transform(RTCGeometry instance, const Affine& to_world) {
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &to_world);
    rtcCommitGeometry(instance);
  }

  void set_area_lights(RTCGeometry quads) {
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
};

Accel::Accel(const Scene& scene, const World& world, const AccelSettings& settings)
    : impl_(std::make_unique<Impl>(scene, world, settings)) {}

Accel::~Accel() = default;

void Accel::rebind(const Scene& scene, const World& world) {
  impl_->scene = &scene;
  impl_->world = &world;
  // Filters hold pointers into the world.
  for (std::size_t id = 0; id < impl_->entries.size(); ++id) {
    const auto [placement, primitive] = impl_->entries[id];
    RTCGeometry geometry = impl_->geometries[id];
    if (placement == Hit::kAreaLightHit) {
      impl_->set_area_lights(geometry);
    } else if (placement == Hit::kSolid) {
      impl_->solid_geometries[primitive].world = &world;
    }
  }
  for (std::size_t i = 0; i < impl_->traced.size(); ++i) impl_->traced[i].part = &world.parts[i];
}

void Accel::update_transforms(const Scene& scene, const World& world) {
  const World& before = *impl_->world;
  std::vector<Affine> old;
  for (const Placement& p : before.placements) old.push_back(p.to_world);
  rebind(scene, world);
  for (std::size_t id = 0; id < impl_->entries.size(); ++id) {
    const auto [placement, primitive] = impl_->entries[id];
    if (placement == Hit::kAreaLightHit) continue;
    if (placement == Hit::kSolid) {
      fill_solids(impl_->solid_geometries[primitive], world);
      rtcCommitGeometry(impl_->geometries[id]);
      continue;
    }
    const Placement& p = world.placements[placement];
    if (old[placement] == p.to_world) continue;
    RTCGeometry geometry = impl_->geometries[id];
    if (impl_->mesh_scenes[p.mesh]) {
      Impl::set_instance_transform(geometry, p.to_world);
    } else {
      impl_->set_vertices(geometry, world.part(placement, primitive).primitive->positions, &p.to_world);
      rtcCommitGeometry(geometry);
      ++impl_->builds.meshes;
    }
  }
  impl_->commit_top();
}

=======
>>>>>>> live
bool Accel::intersect(const Ray& ray, std::uint32_t random, Hit& hit) const {
  Query query = impl_->query(&random, false);
  RTCRayHit r;
  set_ray(r.ray, ray);
  r.hit.geomID = kInvalidId;
  r.hit.instID[0] = kInvalidId;
  embree_intersect(impl_->top, r, query);
  hit = impl_->to_hit(r.ray.tfar, r.hit.u, r.hit.v, r.hit.instID[0], r.hit.geomID, r.hit.primID,
                      [&] { return Vec3f(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z); });
  return hit.placement != Hit::kMiss;
}

bool Accel::occluded(const Ray& ray, std::uint32_t random) const {
  Query query = impl_->query(&random, false);
  RTCRay r;
  set_ray(r, ray);
  embree_occluded(impl_->top, r, query);
  return r.tfar < 0;
}

void Accel::intersect(const RayPacket& rays, std::array<Hit, RayPacket::kSize>& hits) const {
  Query query = impl_->query(rays.random, true);
  RTCRayHit16 r;
  const Lanes lanes = set_rays(r.ray, rays);
  std::ranges::fill(r.hit.geomID, kInvalidId);
  std::ranges::fill(r.hit.instID[0], kInvalidId);
  embree_intersect(impl_->top, lanes.valid, r, query);
  for (int i = 0; i < rays.count; ++i)
    hits[i] =
        impl_->to_hit(r.ray.tfar[i], r.hit.u[i], r.hit.v[i], r.hit.instID[0][i], r.hit.geomID[i],
                      r.hit.primID[i], [&] { return Vec3f(r.hit.Ng_x[i], r.hit.Ng_y[i], r.hit.Ng_z[i]); });
}

std::uint32_t Accel::occluded(const RayPacket& rays) const {
  Query query = impl_->query(rays.random, false);
  RTCRay16 r;
  const Lanes lanes = set_rays(r, rays);
  embree_occluded(impl_->top, lanes.valid, r, query);
  std::uint32_t blocked = 0;
  for (int i = 0; i < rays.count; ++i) blocked |= std::uint32_t(r.tfar[i] < 0) << i;
  return blocked;
}

std::size_t Accel::crossings(const Ray& ray, std::uint32_t random, std::span<Hit> hits,
                             const Body* body) const {
  assert(!impl_->world->media.empty());
  Crossings crossings{hits, impl_->world, body, random};
  Query query = impl_->query(&random, false);
  query.crossings = &crossings;
  RTCRayHit r;
  set_ray(r.ray, ray);
  r.hit.geomID = kInvalidId;
  r.hit.instID[0] = kInvalidId;
  embree_visit(impl_->top, r, query, Impl::collect);
  return crossings.count;
}

}  // namespace parian
