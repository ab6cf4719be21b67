/// How a light table follows an edit that leaves all lights as they are.
#include <algorithm>
#include <span>

#include "renderer/light/light_table.h"

namespace parian {
namespace {

template <class T>
bool is_same_array(const SharedArray<T>& a, const SharedArray<T>& b) {
  return a.data() == b.data() && a.size() == b.size();
}

bool is_same_texture(const Scene& a, const Scene& b, const TextureRef& in_a, const TextureRef& in_b) {
  if (!(in_a == in_b)) return false;
  if (!in_a) return true;
  const Texture &one = a.textures[std::size_t(in_a.texture)], &two = b.textures[std::size_t(in_b.texture)];
  return one == two && a.images[std::size_t(one.image)] == b.images[std::size_t(two.image)];
}

/// Whether two materials make lights of one power.
bool emits_alike(const Scene& a, const Scene& b, const Material& in_a, const Material& in_b) {
  return in_a.emission == in_b.emission && in_a.double_sided == in_b.double_sided &&
         is_same_texture(a, b, in_a.emission_texture, in_b.emission_texture);
}

bool is_same_environment(const Scene& a, const Scene& b) {
  if (!(a.environment == b.environment)) return false;
  const int image = a.environment.image;
  return image == kNone || a.images[std::size_t(image)] == b.images[std::size_t(image)];
}

bool is_same(const AreaLight& a, const AreaLight& b) {
  return a.center == b.center && a.half_x == b.half_x && a.half_y == b.half_y && a.normal == b.normal &&
         a.radiance == b.radiance && a.disk == b.disk;
}

bool is_same(const PunctualLight& a, const PunctualLight& b) {
  return a.kind == b.kind && a.position == b.position && a.direction == b.direction &&
         a.intensity == b.intensity && a.range == b.range && a.cos_inner == b.cos_inner &&
         a.cos_outer == b.cos_outer;
}

/// A placed primitive that emits.
struct Emitter {
  const Part* part;
  const Affine* to_world;
};

std::vector<Emitter> find_emitters(const World& world) {
  std::vector<Emitter> emitters;
  if (std::ranges::none_of(world.parts, &Part::emissive)) return emitters;
  for (const Placement& p : world.placements)
    for (const Part& part : std::span(world.parts).subspan(p.first_part, p.part_count))
      if (part.emissive) emitters.push_back({&part, &p.to_world});
  return emitters;
}

std::vector<const PlacedSolid*> find_emissive_solids(const World& world) {
  std::vector<const PlacedSolid*> solids;
  if (std::ranges::none_of(world.solid_parts, &Part::emissive)) return solids;
  for (const PlacedSolid& solid : world.solids)
    if (world.solid_parts[solid.part].emissive) solids.push_back(&solid);
  return solids;
}

bool has_same_emitters(const Scene& a, const World& in_a, const Scene& b, const World& in_b) {
  const auto is_same_emitter = [&](const Emitter& one, const Emitter& two) {
    const Primitive &p = *one.part->primitive, &q = *two.part->primitive;
    return *one.to_world == *two.to_world && is_same_array(p.positions, q.positions) &&
           is_same_array(p.triangles, q.triangles) && is_same_array(p.uvs[0], q.uvs[0]) &&
           is_same_array(p.uvs[1], q.uvs[1]) && emits_alike(a, b, *one.part->material, *two.part->material);
  };
  const auto is_same_solid = [&](const PlacedSolid* one, const PlacedSolid* two) {
    return one->solid == two->solid && one->to_world == two->to_world &&
           one->round_radius == two->round_radius &&
           emits_alike(a, b, *in_a.solid_parts[one->part].material, *in_b.solid_parts[two->part].material);
  };
  return std::ranges::equal(find_emitters(in_a), find_emitters(in_b), is_same_emitter) &&
         std::ranges::equal(find_emissive_solids(in_a), find_emissive_solids(in_b), is_same_solid);
}

}  // namespace

bool LightTable::rebind(const Scene& scene, const World& world) {
  const auto same = [](const auto& a, const auto& b) { return is_same(a, b); };
  // The power of what has no place goes with the size of the scene.
  const bool same_powers = chooser_.is_by_place() || world.bounds == world_->bounds;
  if (!same_powers || !is_same_environment(*scene_, scene) ||
      !std::ranges::equal(world_->area_lights, world.area_lights, same) ||
      !std::ranges::equal(world_->punctual_lights, world.punctual_lights, same) ||
      !has_same_emitters(*scene_, *world_, scene, world))
    return false;
  scene_ = &scene;
  world_ = &world;
  // Lights have the numbers that they had, in whatever places they now stand in the world.
  triangles_ = EmissiveTriangles(world);
  solids_.clear();
  solid_lights_.clear();
  add_solids();
  environment_.rebind(scene);
  return true;
}

}  // namespace parian
