#include "renderer/light/light_table.h"

#include "renderer/base/sampling.h"

namespace parian {
namespace {

// A float in [0, 1) has 24 bits. Up to this many lights one number serves for the choice and, rescaled, for
// the point.
constexpr int kMaxLightsForOneNumber = 64;

// Up to this many lights are chosen by their power: it takes 25 ns for a sample and 5 for a density where the
// tree takes 60 and 30, and so few leave it little to gain.
constexpr int kMaxLightsByPower = 4;

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

std::array<Vec2f, 2> solid_uvs(const PlacedSolid& placed, const SurfaceSample& point) {
  const Vec2f uv = surface_point(placed.solid, point.p, point.face).uv;
  return {uv, uv};
}

}  // namespace

LightTable::LightTable(const Scene& scene, const World& world, LightChoice choice)
    : scene_(&scene), world_(&world), environment_(scene) {
  bool emissive = false;
  for (const Part& part : world.parts) emissive |= part.emissive;
  if (emissive) {
    first_triangle_.reserve(world.slot_count);
    for (const Placement& placement : world.placements) add_placement(placement);
  }
  add_solids();
  first_solid_ = int(triangles_.size());
  first_area_ = first_solid_ + int(solids_.size());
  first_punctual_ = first_area_ + int(world.area_lights.size());
  environment_index_ = first_punctual_ + int(world.punctual_lights.size());
  count_ = environment_index_ + (environment_.black() ? 0 : 1);
  if (count_ > 1) chooser_ = make_chooser(choice);
}

LightChooser LightTable::make_chooser(LightChoice choice) const {
  std::vector<float> weights = powers();
  if (choice == LightChoice::tree && count_ > kMaxLightsByPower)
    return {all_bounds(weights), infinite_lights()};
  if (choice == LightChoice::uniform)
    for (float& weight : weights) weight = weight > 0 ? 1 : 0;
  return LightChooser(weights);
}

void LightTable::add_placement(const Placement& placement) {
  for (std::uint32_t i = 0; i < placement.part_count; ++i) {
    first_triangle_.push_back(std::uint32_t(triangles_.size()));
    const Part& part = world_->parts[placement.first_part + i];
    if (!part.emissive) continue;
    const Affine& m = placement.to_world;
    for (std::uint32_t k = 0; k < part.primitive->triangles.size(); ++k) {
      const Triangle& t = part.primitive->triangles[k];
      const Vec3f &a = part.primitive->positions[t[0]], &b = part.primitive->positions[t[1]],
                  &c = part.primitive->positions[t[2]];
      const Vec3f normal = m.normal((b - a).cross(c - a));
      EmissiveTriangle e{m.point(a), m.vector(b - a), m.vector(c - a), normal.normalized(), 0, 0, &part, k};
      e.area = 0.5f * e.e1.cross(e.e2).length();
      e.offset = plane_offset(placement.extent(max_component(max(abs(a), max(abs(b), abs(c))))));
      triangles_.push_back(e);
    }
  }
}

void LightTable::add_solids() {
  for (std::uint32_t i = 0; i < world_->solids.size(); ++i) {
    if (!world_->solid_parts[world_->solids[i].part].emissive) continue;
    solid_lights_.resize(world_->solids.size());
    solid_lights_[i] = std::uint32_t(solids_.size());
    solids_.push_back(i);
  }
}

/// Mean luminance of a material's emission over a surface, whose point for u in the unit square has the
/// coordinates uvs_at(u).
template <class UvsAt>
float LightTable::mean_emission(const Material& material, const UvsAt& uvs_at) const {
  Rgb mean = material.emission;
  if (material.emission_texture) {
    // Sixteen points estimate the texture's mean; a tenth of the factor keeps what they miss from being
    // starved.
    mean *= 0.1f;
    for (int i = 0; i < 16; ++i) {
      const Vec2f u((float(i) + 0.5f) / 16, to_unit_float(reverse_bits(std::uint32_t(i))));
      mean += eval_emission(*scene_, material, uvs_at(u), 1) * (0.9f / 16);
    }
  }
  return luminance(mean) * (material.double_sided ? 2 : 1);
}

float LightTable::power(const EmissiveTriangle& e) const {
  const Triangle& t = e.part->primitive->triangles[e.triangle];
  return kPi * e.area * mean_emission(*e.part->material, [&](const Vec2f& u) {
           const Vec2f b = sample_triangle(u);
           return interpolate_uvs(*e.part->primitive, t, b.x, b.y);
         });
}

float LightTable::power(const PlacedSolid& placed) const {
  const double world_area =
      placed.is_round() ? area(Sphere{placed.round_radius}) : area(placed.solid, placed.to_world);
  return kPi * float(world_area) *
         mean_emission(*world_->solid_parts[placed.part].material,
                       [&](const Vec2f& u) { return solid_uvs(placed, sample_surface(placed.solid, u)); });
}

float LightTable::power(const AreaLight& light) const {
  const float area = 4 * light.half_x.length() * light.half_y.length() * (light.disk ? kPi / 4 : 1);
  return luminance(light.radiance) * area * kPi;
}

float LightTable::power(const PunctualLight& light, float scene_radius) const {
  switch (light.kind) {
    case LightKind::directional:
      return luminance(light.intensity) * kPi * scene_radius * scene_radius;
    case LightKind::spot:
      return luminance(light.intensity) * 2 * kPi * (1 - 0.5f * (light.cos_inner + light.cos_outer));
    default:
      return luminance(light.intensity) * 4 * kPi;
  }
}

std::vector<float> LightTable::powers() const {
  const float radius = world_->bounds.isEmpty() ? 1 : 0.5f * world_->bounds.size().length();
  std::vector<float> powers;
  powers.reserve(std::size_t(count_));
  for (const EmissiveTriangle& t : triangles_) powers.push_back(power(t));
  for (const std::uint32_t solid : solids_) powers.push_back(power(world_->solids[solid]));
  for (const AreaLight& light : world_->area_lights) powers.push_back(power(light));
  for (const PunctualLight& light : world_->punctual_lights) powers.push_back(power(light, radius));
  if (!environment_.black())
    powers.push_back(environment_.mean_luminance() * 4 * kPi * kPi * radius * radius);
  return powers;
}

LightBounds LightTable::bounds(const EmissiveTriangle& e, float power) const {
  LightBounds bounds;
  for (const Vec3f& vertex : {e.v0, e.v0 + e.e1, e.v0 + e.e2}) bounds.box.extendBy(vertex);
  bounds.axis = e.ng;
  bounds.two_sided = e.part->material->double_sided;
  bounds.intensity = power * (bounds.two_sided ? 0.5f : 1) * kInvPi;
  return bounds;
}

LightBounds LightTable::bounds(const PlacedSolid& placed, float power) const {
  // Convex: its mean projected area is a quarter of the surface (Cauchy). Of light inside of it nothing is
  // known but that it is there.
  LightBounds bounds;
  bounds.box = parian::bounds(placed.solid, placed.to_world);
  bounds.cos_o = -1;
  bounds.intensity = power * 0.25f * kInvPi;
  return bounds;
}

LightBounds LightTable::bounds(const AreaLight& light, float power) const {
  LightBounds bounds;
  const Vec3f half = abs(light.half_x) + abs(light.half_y);
  bounds.box = {light.center - half, light.center + half};
  bounds.axis = light.normal;
  bounds.intensity = power * kInvPi;
  return bounds;
}

LightBounds LightTable::bounds(const PunctualLight& light) const {
  LightBounds bounds;
  if (light.kind == LightKind::directional) return bounds;
  bounds.box = {light.position, light.position};
  bounds.intensity = luminance(light.intensity);
  if (light.range > 0) bounds.range = light.range;
  bounds.cos_o = -1;
  if (light.kind == LightKind::spot) {
    // The angles from rounded cosines, and so with a margin.
    bounds.axis = light.direction;
    bounds.cos_o = light.cos_inner;
    bounds.cos_e = std::cos(std::acos(light.cos_outer) - std::acos(light.cos_inner) + 1e-3f);
  }
  return bounds;
}

std::vector<LightBounds> LightTable::all_bounds(const std::vector<float>& powers) const {
  std::vector<LightBounds> all;
  all.reserve(powers.size());
  const auto next_power = [&] { return powers[all.size()]; };
  for (const EmissiveTriangle& t : triangles_) all.push_back(bounds(t, next_power()));
  for (const std::uint32_t solid : solids_) all.push_back(bounds(world_->solids[solid], next_power()));
  for (const AreaLight& light : world_->area_lights) all.push_back(bounds(light, next_power()));
  for (const PunctualLight& light : world_->punctual_lights) all.push_back(bounds(light));
  all.resize(powers.size());
  return all;
}

std::vector<InfiniteLight> LightTable::infinite_lights() const {
  std::vector<InfiniteLight> lights;
  for (int i = first_punctual_; i < environment_index_; ++i) {
    const PunctualLight& light = world_->punctual_lights[std::size_t(i - first_punctual_)];
    if (light.kind == LightKind::directional)
      lights.push_back({i, luminance(light.intensity), -light.direction});
  }
  if (!environment_.black())
    lights.push_back({environment_index_, kPi * environment_.mean_luminance(), Vec3f(0)});
  return lights;
}

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
  if (light < first_solid_) return sample_emissive(triangles_[light], probability, p, u);
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
  const Placement& placement = world_->placements[hit.placement];
  const int light = int(first_triangle_[placement.first_slot + hit.primitive] + hit.triangle);
  return choice(to, light) * hit.t * hit.t / (triangles_[light].area * cosine);
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
