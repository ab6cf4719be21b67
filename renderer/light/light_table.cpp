#include "renderer/light/light_table.h"

#include "renderer/base/sampling.h"

namespace parian {
namespace {

// A float in [0, 1) has 24 bits. Up to this many lights one number serves for the choice and, rescaled, for
// the point.
constexpr int kMaxLightsForOneNumber = 64;

/// A density that a light touching its receiver, or seen edge on, makes infinite or zero is no sample.
bool usable(float pdf) { return pdf > 0 && pdf < kInfinity; }

/// A number in [0, 1) of 48 bits, stratified as u.x.
double many_bits(const Vec2f& u) { return double(u.x) + 0x1p-24 * double(u.y); }

/// A point of a flat light of some area, chosen uniformly with the light's probability; all but its radiance.
/// Nothing where it shows p its dark side.
std::optional<LightSample> area_sample(const Vec3f& p, const Vec3f& point, const Vec3f& normal, float offset,
                                       float area, float probability, bool double_sided) {
  const Vec3f to_light = point - p;
  const float distance2 = to_light.dot(to_light);
  const Vec3f wi = to_light * (1 / std::sqrt(distance2));
  const float cosine = -wi.dot(normal);
  const float pdf = probability * distance2 / (area * std::abs(cosine));
  if (!usable(pdf) || (!double_sided && cosine <= 0)) return std::nullopt;
  return LightSample{wi, Rgb(0, 0, 0), pdf, false, false, point + normal * std::copysign(offset, cosine)};
}

}  // namespace

std::optional<LightSample> LightTable::sample(const Receiver& to, Vec2f u, Sampler& sampler) const {
  const Vec3f& p = to.p;
  int light = 0;
  float probability = 1;
  if (count_ > 1) {
    const bool one_number = count_ <= kMaxLightsForOneNumber;
    const LightChooser::Choice chosen = chooser_.choose(to, one_number ? u.x : many_bits(sampler.next2()));
    light = chosen.light;
    probability = chosen.probability;
    if (one_number) u.x = chosen.remainder;
    if (probability <= 0) return std::nullopt;
  }
  if (light < first_solid_) {
    const auto records = triangles_.records();
    if (!records.empty()) return sample_emissive(records[std::size_t(light)], probability, p, u);
    return sample_emissive(triangles_.make(light), probability, p, u);
  }
  if (light < first_area_)
    return sample_solid(world_->solids[solids_[light - first_solid_]], probability, p, u);
  if (light < first_punctual_)
    return sample_area(world_->area_lights[light - first_area_], probability, p, u);
  if (light < environment_index_)
    return sample_punctual(world_->punctual_lights[light - first_punctual_], probability, p);
  return sample_environment(probability, u);
}

std::optional<LightSample> LightTable::sample_emissive(const EmissiveTriangle& e, float probability,
                                                       const Vec3f& p, const Vec2f& u) const {
  const Material& material = *e.part->material;
  const Vec2f b = sample_triangle(u);
  const Vec3f point = e.v0 + e.e1 * b.x + e.e2 * b.y;
  std::optional<LightSample> s =
      area_sample(p, point, e.ng, e.offset, e.area, probability, material.double_sided);
  if (!s) return s;
  s->radiance = material.emission;
  if (material.emission_varies()) {
    const Primitive& primitive = *e.part->primitive;
    s->radiance = eval_emission(*scene_, material,
                                interpolate_uvs(primitive, primitive.triangles[e.triangle], b.x, b.y),
                                std::abs(s->wi.dot(e.ng)));
  }
  return s;
}

std::array<Vec2f, 2> LightTable::solid_uvs(const PlacedSolid& placed, const SurfaceSample& point) {
  const Vec2f uv = surface_point(placed.solid, point.p, point.face).uv;
  return {uv, uv};
}

std::optional<LightSample> LightTable::sample_solid(const PlacedSolid& placed, float probability,
                                                    const Vec3f& p, const Vec2f& u) const {
  const Material& material = *world_->solid_parts[placed.part].material;
  std::optional<LightSample> s;
  SurfaceSample point;  // in the space of the solid
  Vec3f normal;
  if (placed.is_round()) {
    const Vec3f center = placed.to_world.origin;
    const auto seen = sample_directions(center, placed.round_radius, p, u);
    if (!seen || !usable(seen->pdf)) return std::nullopt;
    normal = seen->normal;
    const float cosine = -seen->w.dot(normal);
    if (!material.double_sided && cosine <= 0) return std::nullopt;
    const Vec3f from_center = normal * placed.round_radius;
    point = {placed.round_point(normal), Face::side};
    const float offset = std::copysign(solid_offset(placed.to_world, point.p), cosine);
    s = LightSample{seen->w, Rgb(0, 0, 0), probability * seen->pdf,
                    false,   false,        center + from_center + normal * offset};
  } else {
    point = sample_surface(placed.solid, u);
    normal = placed.to_world.normal(surface_point(placed.solid, point.p, point.face).normal);
    const float stretch = normal.length();
    normal /= stretch;
    s = area_sample(p, placed.to_world.point(point.p), normal, solid_offset(placed.to_world, point.p),
                    area(placed.solid) * stretch, probability, material.double_sided);
  }
  if (s) s->radiance = material.emission;
  if (s && material.emission_varies())
    s->radiance = eval_emission(*scene_, material, solid_uvs(placed, point), std::abs(s->wi.dot(normal)));
  return s;
}

std::optional<LightSample> LightTable::sample_area(const AreaLight& light, float probability, const Vec3f& p,
                                                   const Vec2f& u) const {
  const Vec2f q = light.disk ? sample_disk(u) : Vec2f(2 * u.x - 1, 2 * u.y - 1);
  const float area = 4 * light.half_x.length() * light.half_y.length() * (light.disk ? kPi / 4 : 1);
  const float extent = max_component(abs(light.center) + abs(light.half_x) + abs(light.half_y));
  std::optional<LightSample> s = area_sample(p, light.center + light.half_x * q.x + light.half_y * q.y,
                                             light.normal, plane_offset(extent), area, probability, false);
  if (s) s->radiance = light.radiance;
  return s;
}

std::optional<LightSample> LightTable::sample_punctual(const PunctualLight& light, float probability,
                                                       const Vec3f& p) const {
  if (light.kind == LightKind::directional)
    return LightSample{-light.direction, light.intensity, probability, true, true, p};
  const Vec3f to_light = light.position - p;
  const float distance2 = to_light.dot(to_light);
  // At the light itself the inverse square has no value.
  if (!(distance2 > 1e-30f)) return std::nullopt;
  const Vec3f wi = to_light * (1 / std::sqrt(distance2));
  Rgb irradiance = light.intensity * (1 / distance2);
  if (light.range > 0) {
    // KHR_lights_punctual: the recommended window that reaches zero at the range.
    const float ratio2 = distance2 / (light.range * light.range);
    irradiance *= std::clamp(1 - ratio2 * ratio2, 0.0f, 1.0f);
  }
  if (light.kind == LightKind::spot) {
    // KHR_lights_punctual: linear in the cosine between the cones, squared.
    const float cosine = -wi.dot(light.direction);
    const float t = (cosine - light.cos_outer) / std::max(0.001f, light.cos_inner - light.cos_outer);
    irradiance *= std::clamp(t, 0.0f, 1.0f) * std::clamp(t, 0.0f, 1.0f);
  }
  if (is_black(irradiance)) return std::nullopt;
  return LightSample{wi, irradiance, probability, true, false, light.position};
}

std::optional<LightSample> LightTable::sample_environment(float probability, const Vec2f& u) const {
  const EnvironmentSample e = environment_.sample(u);
  if (!usable(e.pdf)) return std::nullopt;
  return LightSample{e.wi, e.radiance, probability * e.pdf, false, true, e.wi};
}

float LightTable::pdf_triangle(const Hit& hit, const Receiver& to, float cosine) const {
  const int light = triangles_.number(hit);
  return choice(to, light) * hit.t * hit.t / (triangles_.area(hit, light) * cosine);
}

float LightTable::pdf_solid(const Hit& hit, const Receiver& to, float cosine) const {
  const PlacedSolid& placed = world_->solids[hit.solid()];
  const float chosen = choice(to, first_solid_ + int(solid_lights_[hit.solid()]));
  if (placed.is_round()) return chosen * pdf_directions(placed.to_world.origin, placed.round_radius, to.p);
  const Vec3f normal = surface_point(placed.solid, {hit.u, hit.v, hit.w}, Face(hit.triangle)).normal;
  return chosen * hit.t * hit.t / (area(placed.solid) * placed.to_world.normal(normal).length() * cosine);
}

float LightTable::pdf_area_light(const Hit& hit, const Receiver& to, float cosine) const {
  const AreaLight& light = world_->area_lights[hit.triangle];
  const float area = 4 * light.half_x.length() * light.half_y.length() * (light.disk ? kPi / 4 : 1);
  return choice(to, first_area_ + int(hit.triangle)) * hit.t * hit.t / (area * cosine);
}

EnvironmentSample LightTable::look_up_environment(const Vec3f& d, const Receiver& to) const {
  EnvironmentSample s = environment_.look_up(d);
  s.pdf *= choice(to, environment_index_);
  return s;
}

}  // namespace parian
