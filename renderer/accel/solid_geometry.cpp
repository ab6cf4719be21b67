#include "renderer/accel/solid_geometry.h"

#include "renderer/accel/query.h"

namespace parian {
namespace {

/// What a crossing that is met hands to Embree. `g`: of a round sphere the unit normal in world space, of
/// another solid the point in its own space.
struct Met {
  Crossing crossing;
  Vec3f g;
};

/// One of the rays that Embree asks about.
struct LaneRay {
  Vec3d o, d;
  float tnear, tfar;
  unsigned id;

  LaneRay(RTCRayN* r, unsigned n, unsigned i)
      : o(RTCRayN_org_x(r, n, i), RTCRayN_org_y(r, n, i), RTCRayN_org_z(r, n, i)),
        d(RTCRayN_dir_x(r, n, i), RTCRayN_dir_y(r, n, i), RTCRayN_dir_z(r, n, i)),
        tnear(RTCRayN_tnear(r, n, i)),
        tfar(RTCRayN_tfar(r, n, i)),
        id(RTCRayN_id(r, n, i)) {}
};

/// The first crossing between the ray's ends that `keep` keeps.
template <class Keep>
const Crossing* first_crossing(const Chord& chord, const LaneRay& ray, const Keep& keep) {
  for (const Crossing* c : {&chord.enter, &chord.leave})
    if (c->t > ray.tnear && c->t < ray.tfar && keep(*c)) return c;
  return nullptr;
}

struct RoundKind {
  static bool meet(const SolidGeometry& geometry, unsigned primitive, const LaneRay& ray, const Query&,
                   Met& met) {
    const SolidGeometry::Round& sphere = geometry.round[primitive];
    const Vec3d from_center = ray.o - Vec3d(sphere.center);
    const std::optional<Chord> chord = intersect(Sphere{sphere.radius}, from_center, ray.d);
    if (!chord) return false;
    const Crossing* c = first_crossing(*chord, ray, [](const Crossing&) { return true; });
    if (!c) return false;
    met = {*c, Vec3f((from_center + ray.d * c->t) * (1.0 / sphere.radius))};
    return true;
  }
};

struct MappedKind {
  static bool meet(const SolidGeometry& geometry, unsigned primitive, const LaneRay& ray, const Query& query,
                   Met& met) {
    const SolidGeometry::Mapped& mapped = geometry.mapped[primitive];
    const Vec3d o = mapped.to_object.point(ray.o), d = mapped.to_object.vector(ray.d);
    const std::optional<Chord> chord = intersect(mapped.solid, o, d);
    if (!chord) return false;
    const auto point = [&](const Crossing& c) { return project(mapped.solid, o + d * c.t, c.face); };
    const Crossing* c = first_crossing(*chord, ray, [&](const Crossing& crossing) {
      if (!mapped.alpha) return true;
      const World& world = *query.world;
      const std::uint32_t index = geometry.solids[primitive];
      const Vec2f uv = surface_point(mapped.solid, point(crossing), crossing.face).uv;
      const Material& material = *world.solid_parts[world.solids[index].part].material;
      const std::uint32_t where = hash32(index, &crossing == &chord->leave);
      return query.meets(ray.id, where, eval_coverage(*query.scene, material, {uv, uv}, 1));
    });
    if (!c) return false;
    met = {*c, point(*c)};
    return true;
  }
};

template <class Kind>
void intersect_solids(const RTCIntersectFunctionNArguments* a) {
  const auto& geometry = *static_cast<const SolidGeometry*>(a->geometryUserPtr);
  const auto& query = *static_cast<const Query*>(a->context);
  RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
  RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
  for (unsigned i = 0; i < a->N; ++i) {
    Met met;
    LaneRay ray(rays, a->N, i);
    if (a->valid[i] != -1 || !Kind::meet(geometry, a->primID, ray, query, met)) continue;
    if (query.crossings) [[unlikely]] {
      do {
        // Beyond the crossing, whose t is a double.
        ray.tnear = std::nextafter(float(met.crossing.t), kInfinity);
        query.crossings->add(to_solid_hit(geometry, ray.tnear, a->primID, float(met.crossing.face), met.g));
      } while (Kind::meet(geometry, a->primID, ray, query, met));
      continue;
    }
    RTCRayN_tfar(rays, a->N, i) = float(met.crossing.t);
    RTCHitN_Ng_x(hits, a->N, i) = met.g.x;
    RTCHitN_Ng_y(hits, a->N, i) = met.g.y;
    RTCHitN_Ng_z(hits, a->N, i) = met.g.z;
    RTCHitN_u(hits, a->N, i) = float(met.crossing.face);
    RTCHitN_v(hits, a->N, i) = 0;
    RTCHitN_primID(hits, a->N, i) = a->primID;
    RTCHitN_geomID(hits, a->N, i) = a->geomID;
    RTCHitN_instID(hits, a->N, i, 0) = a->context->instID[0];
  }
}

template <class Kind>
void occlude_solids(const RTCOccludedFunctionNArguments* a) {
  const auto& geometry = *static_cast<const SolidGeometry*>(a->geometryUserPtr);
  const auto& query = *static_cast<const Query*>(a->context);
  for (unsigned i = 0; i < a->N; ++i) {
    Met met;
    if (a->valid[i] == -1 && Kind::meet(geometry, a->primID, LaneRay(a->ray, a->N, i), query, met))
      RTCRayN_tfar(a->ray, a->N, i) = -kInfinity;
  }
}

void bound_solid(const RTCBoundsFunctionArguments* a) {
  const auto& geometry = *static_cast<const SolidGeometry*>(a->geometryUserPtr);
  const PlacedSolid& placed = geometry.world->solids[geometry.solids[a->primID]];
  const Box3f box = bounds(placed.solid, placed.to_world);
  *a->bounds_o = {box.min.x, box.min.y, box.min.z, 0, box.max.x, box.max.y, box.max.z, 0};
}

}  // namespace

std::vector<SolidGeometry> sort_solids(const World& world) {
  SolidGeometry round, mapped;
  for (std::uint32_t i = 0; i < world.solids.size(); ++i) {
    const PlacedSolid& placed = world.solids[i];
    const bool is_round = placed.is_round() && !world.solid_parts[placed.part].alpha;
    (is_round ? round : mapped).solids.push_back(i);
  }
  round.round.resize(round.solids.size());
  mapped.mapped.resize(mapped.solids.size());
  std::vector<SolidGeometry> geometries;
  for (SolidGeometry* geometry : {&round, &mapped}) {
    if (geometry->solids.empty()) continue;
    fill_solids(*geometry, world);
    geometries.push_back(std::move(*geometry));
  }
  return geometries;
}

void fill_solids(SolidGeometry& geometry, const World& world) {
  geometry.world = &world;
  for (std::size_t i = 0; i < geometry.solids.size(); ++i) {
    const PlacedSolid& placed = world.solids[geometry.solids[i]];
    if (geometry.round.empty())
      geometry.mapped[i] = {inverse(placed.to_world), placed.solid, world.solid_parts[placed.part].alpha};
    else
      geometry.round[i] = {placed.to_world.origin, placed.round_radius};
  }
}

RTCGeometry new_solid_geometry(RTCDevice device, SolidGeometry& geometry) {
  RTCGeometry result = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(result, unsigned(geometry.solids.size()));
  rtcSetGeometryUserData(result, &geometry);
  rtcSetGeometryBoundsFunction(result, bound_solid, nullptr);
  const bool round = !geometry.round.empty();
  rtcSetGeometryIntersectFunction(result, round ? intersect_solids<RoundKind> : intersect_solids<MappedKind>);
  rtcSetGeometryOccludedFunction(result, round ? occlude_solids<RoundKind> : occlude_solids<MappedKind>);
  return result;
}

Hit to_solid_hit(const SolidGeometry& geometry, float t, unsigned primitive, float face, const Vec3f& g) {
  const std::uint32_t index = geometry.solids[primitive];
  const Vec3f point = geometry.round.empty() ? g : geometry.world->solids[index].round_point(g);
  return {t, point.x, point.y, Hit::kSolid | index, 0, std::uint32_t(face), point.z};
}

}  // namespace parian
