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
