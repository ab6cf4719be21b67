/// What of material_properties.h is about the models of a material.
#include <algorithm>

#include "editing/material_properties.h"
#include "scene_io/metals.h"
#include "scene_io/scattering_materials.h"

namespace parian::edit {
namespace {

constexpr const char* kTypes[] = {"metallic-roughness", "phong", "conductor", "subsurface"};

void set_type(Material& m, MaterialType type) {
  if (type == type_of(m)) return;
  m.phong.reset();
  m.conductor.reset();
  m.subsurface.reset();
  switch (type) {
    case MaterialType::metallic_roughness:
      break;
    case MaterialType::phong:
      m.phong = PhongModel{m.base_color * 0.8f, Rgb(0.2f), 50};
      break;
    case MaterialType::conductor:
      m.conductor = find_metal("aluminium");
      break;
    case MaterialType::subsurface:
      m.scatter.reset();
      set_substance(m, "marble");
  }
}

}  // namespace

MaterialType type_of(const Material& m) {
  if (m.phong) return MaterialType::phong;
  if (m.conductor) return MaterialType::conductor;
  return m.subsurface ? MaterialType::subsurface : MaterialType::metallic_roughness;
}

Material fresh_material() {
  Material m;
  m.transmission.emplace();
  m.volume.emplace();
  m.scatter.emplace();
  m.diffuse_transmission.emplace();
  m.clearcoat.emplace();
  m.sheen.emplace();
  m.anisotropy.emplace();
  m.iridescence.emplace();
  m.phong.emplace();
  m.conductor.emplace();
  m.subsurface.emplace();
  return m;
}

void set_substance(Material& material, const std::string& name) {
  const auto known = find_scattering_material(name);
  if (!known) refuse(fmt::format("Substance: expected one that is known, not {}", name));
  constexpr float kPerMetre = 1000;
  material.subsurface = {known->absorption * kPerMetre, known->reduced_scattering * kPerMetre};
  material.ior = known->eta;
}

void add_type(PropertyList<Material>& list) {
  const std::vector<std::string> choices(std::begin(kTypes), std::end(kTypes));
  list.add(
      PropertyKind::choice, {"type", "Type"},
      [](const Material& m) { return std::string(kTypes[std::size_t(type_of(m))]); },
      [choices](Material& m, const PropertyValue& v) {
        const auto at = std::find(choices.begin(), choices.end(), std::get<std::string>(v));
        set_type(m, MaterialType(at - choices.begin()));
      },
      choices);
}

}  // namespace parian::edit
