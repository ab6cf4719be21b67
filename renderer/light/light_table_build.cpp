/// The light table as it is built: what each light's power is and what bounds it.
#include "renderer/base/parallel.h"
#include "renderer/base/sampling.h"
#include "renderer/light/light_table.h"

namespace parian {
namespace {

// Up to this many lights are chosen by their power: it takes 25 ns for a sample and 5 for a density where the
// tree takes 60 and 30, and so few leave it little to gain.
constexpr int kMaxLightsByPower = 4;
// Lights handed to a thread at a time.
constexpr std::size_t kGrain = 1024;
// Of a texture, to estimate its mean over a light.
constexpr int kPoints = 16;

/// How many points estimate the mean of the emission over a triangle: one where it is within a texel, four
/// within some.
int points_for(const Scene& scene, const Material& material, const Primitive& primitive, const Triangle& t) {
  const TextureRef& texture = material.emission_texture;
  if (!texture) return 1;
  const SharedArray<Vec2f>& uvs = primitive.uvs[std::size_t(texture.uv_set)];
  if (uvs.empty()) return 1;
  const Image& image = scene.images[std::size_t(scene.textures[std::size_t(texture.texture)].image)];
  const std::array<float, 6>& m = texture.transform;
  float extent = 0;
  for (int i = 1; i < 3; ++i) {
    const Vec2f edge = uvs[t[i]] - uvs[t[0]];
    extent = std::max({extent, std::abs(m[0] * edge.x + m[1] * edge.y) * float(image.width),
                       std::abs(m[3] * edge.x + m[4] * edge.y) * float(image.height)});
  }
  return extent <= 1 ? 1 : extent <= 4 ? 4 : kPoints;
}

}  // namespace

LightTable::LightTable(const Scene& scene, const World& world, LightChoice choice)
    : scene_(&scene), world_(&world), triangles_(world), environment_(scene) {
  add_solids();
  first_solid_ = triangles_.size();
  first_area_ = first_solid_ + int(solids_.size());
  first_punctual_ = first_area_ + int(world.area_lights.size());
  environment_index_ = first_punctual_ + int(world.punctual_lights.size());
  count_ = environment_index_ + (environment_.black() ? 0 : 1);
  if (count_ > 1) chooser_ = make_chooser(choice);
}

LightChooser LightTable::make_chooser(LightChoice choice) const {
  if (choice == LightChoice::tree && count_ > kMaxLightsByPower)
    return {std::size_t(count_), [this](std::size_t i) { return bounds(int(i)); }, infinite_lights()};
  std::vector<float> weights = powers();
  if (choice == LightChoice::uniform)
    for (float& weight : weights) weight = weight > 0 ? 1 : 0;
  return LightChooser(weights);
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
/// coordinates uvs_at(u), by so many points.
template <class UvsAt>
float LightTable::mean_emission(const Material& material, int points, const UvsAt& uvs_at) const {
  Rgb mean = material.emission;
  if (material.emission_texture) {
    // Some points estimate the texture's mean; a tenth of the factor keeps what they miss from being starved.
    mean *= 0.1f;
    const float step = 1 / float(points);
    for (int i = 0; i < points; ++i) {
      const Vec2f u((float(i) + 0.5f) * step, to_unit_float(reverse_bits(std::uint32_t(i))) + 0.5f * step);
      mean += eval_emission(*scene_, material, uvs_at(u), 1) * (0.9f * step);
    }
  }
  return luminance(mean) * (material.double_sided ? 2 : 1);
}

float LightTable::power(const EmissiveTriangle& e) const {
  const Primitive& primitive = *e.part->primitive;
  const Triangle& t = primitive.triangles[e.triangle];
  return kPi * e.area *
         mean_emission(*e.part->material, points_for(*scene_, *e.part->material, primitive, t),
                       [&](const Vec2f& u) {
                         const Vec2f b = sample_triangle(u);
                         return interpolate_uvs(primitive, t, b.x, b.y);
                       });
}

float LightTable::power(const PlacedSolid& placed) const {
  const double world_area =
      placed.is_round() ? area(Sphere{placed.round_radius}) : area(placed.solid, placed.to_world);
  return kPi * float(world_area) *
         mean_emission(*world_->solid_parts[placed.part].material, kPoints,
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

float LightTable::power(int light) const {
  const float radius = world_->bounds.isEmpty() ? 1 : 0.5f * world_->bounds.size().length();
  if (light < first_solid_) return power(triangles_.make(light));
  if (light < first_area_) return power(world_->solids[solids_[light - first_solid_]]);
  if (light < first_punctual_) return power(world_->area_lights[light - first_area_]);
  if (light < environment_index_) return power(world_->punctual_lights[light - first_punctual_], radius);
  return environment_.mean_luminance() * 4 * kPi * kPi * radius * radius;
}

std::vector<float> LightTable::powers() const {
  std::vector<float> powers(static_cast<std::size_t>(count_));
  parallel_for(powers.size(), kGrain, [&](std::size_t i) { powers[i] = power(int(i)); });
  return powers;
}

LightBounds LightTable::bounds(const EmissiveTriangle& e) const {
  LightBounds bounds;
  for (const Vec3f& vertex : {e.v0, e.v0 + e.e1, e.v0 + e.e2}) bounds.box.extendBy(vertex);
  bounds.axis = e.ng;
  bounds.two_sided = e.part->material->double_sided;
  bounds.intensity = power(e) * (bounds.two_sided ? 0.5f : 1) * kInvPi;
  return bounds;
}

LightBounds LightTable::bounds(const PlacedSolid& placed) const {
  // Convex: its mean projected area is a quarter of the surface (Cauchy). Of light inside of it nothing is
  // known but that it is there.
  LightBounds bounds;
  bounds.box = parian::bounds(placed.solid, placed.to_world);
  bounds.cos_o = -1;
  bounds.intensity = power(placed) * 0.25f * kInvPi;
  return bounds;
}

LightBounds LightTable::bounds(const AreaLight& light) const {
  LightBounds bounds;
  const Vec3f half = abs(light.half_x) + abs(light.half_y);
  bounds.box = {light.center - half, light.center + half};
  bounds.axis = light.normal;
  bounds.intensity = power(light) * kInvPi;
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

LightBounds LightTable::bounds(int light) const {
  if (light < first_solid_) return bounds(triangles_.make(light));
  if (light < first_area_) return bounds(world_->solids[solids_[light - first_solid_]]);
  if (light < first_punctual_) return bounds(world_->area_lights[light - first_area_]);
  if (light < environment_index_) return bounds(world_->punctual_lights[light - first_punctual_]);
  return {};
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

std::size_t LightTable::bytes() const {
  return triangles_.bytes() + (solids_.capacity() + solid_lights_.capacity()) * sizeof(std::uint32_t) +
         chooser_.bytes();
}

LightTableBytes light_table_bytes(std::size_t lights, LightChoice choice, std::size_t slots) {
  const std::size_t triangles = EmissiveTriangles::predicted_bytes(lights, slots);
  if (lights < 2) return {triangles, triangles};
  if (choice == LightChoice::tree && lights > std::size_t(kMaxLightsByPower))
    return {triangles + LightTree::predicted_bytes(lights),
            triangles + LightTree::predicted_peak_bytes(lights)};
  const std::size_t held = triangles + Distribution1D::predicted_bytes(lights);
  return {held, held + lights * sizeof(float)};
}

}  // namespace parian
