/// material_properties().
#include "editing/material_properties.h"

#include <algorithm>

#include "scene_io/metals.h"
#include "scene_io/scattering_materials.h"

namespace parian::edit {
namespace {

constexpr double kMaxPriority = 2147483647;

void add_alpha(PropertyList<Material>& list, AlphaMode mode) {
  static constexpr const char* kModes[] = {"opaque", "mask", "blend"};
  const std::vector<std::string> choices(std::begin(kModes), std::end(kModes));
  list.add(
      PropertyKind::choice, {"alpha_mode", "Alpha"},
      [](const Material& m) { return std::string(kModes[std::size_t(m.alpha_mode)]); },
      [choices](Material& m, const PropertyValue& v) {
        const auto at = std::find(choices.begin(), choices.end(), std::get<std::string>(v));
        m.alpha_mode = AlphaMode(at - choices.begin());
      },
      choices);
  if (mode != AlphaMode::opaque)
    list.number(
        {"alpha", "Opacity"}, [](auto& m) -> auto& { return m.alpha; });
  if (mode == AlphaMode::mask)
    list.number(
        {"alpha_cutoff", "Opaque from", "", 0, kMost}, [](auto& m) -> auto& { return m.alpha_cutoff; });
}

void add_base_color(PropertyList<Material>& list) {
  list.color(
      {"base_color", "Base colour"}, [](auto& m) -> auto& { return m.base_color; });
}

void add_roughness(PropertyList<Material>& list) {
  list.number(
      {"roughness", "Roughness"}, [](auto& m) -> auto& { return m.roughness; });
}

void add_ior(PropertyList<Material>& list, const MaterialType type) {
  list.add(
      PropertyKind::number, {"ior", "Index of refraction", "", 0, kMost},
      [](const Material& m) { return double(m.ior); },
      [type](Material& m, const PropertyValue& v) {
        m.ior = float(std::get<double>(v));
        const bool infinite = m.ior == 0 && type != MaterialType::subsurface;
        if (!(m.ior >= 1) && !infinite)
          refuse(fmt::format("Index of refraction: expected {}a number of at least 1, not {}",
                             type != MaterialType::subsurface ? "0 (infinite) or " : "", m.ior));
      });
}

void add_phong(PropertyList<Material>& list) {
  list.color(
      {"phong.diffuse", "Diffuse"}, [](auto& m) -> auto& { return m.phong->diffuse; });
  list.color(
      {"phong.specular", "Specular"}, [](auto& m) -> auto& { return m.phong->specular; });
  list.number(
      {"phong.exponent", "Exponent", "", 0, kMost, 1}, [](auto& m) -> auto& { return m.phong->exponent; });
}

constexpr const char* kCustom = "custom";

void add_conductor(PropertyList<Material>& list) {
  std::vector<std::string> names = metal_names();
  names.insert(names.begin(), kCustom);
  list.add(
      PropertyKind::choice, {"conductor.metal", "Metal"},
      [](const Material& m) {
        for (const std::string& name : metal_names())
          if (find_metal(name) == m.conductor) return name;
        return std::string(kCustom);
      },
      [](Material& m, const PropertyValue& v) {
        if (const auto metal = find_metal(std::get<std::string>(v))) m.conductor = metal;
      },
      std::move(names));
  list.color(
      {"conductor.eta", "Index n", "", 0, kMost}, [](auto& m) -> auto& { return m.conductor->eta; });
  list.color(
      {"conductor.k", "Index k", "", 0, kMost}, [](auto& m) -> auto& { return m.conductor->k; });
  add_roughness(list);
}

void add_subsurface(PropertyList<Material>& list) {
  std::vector<std::string> names = scattering_material_names();
  names.insert(names.begin(), kCustom);
  list.add(
      PropertyKind::choice, {"subsurface.substance", "Substance"},
      [](const Material& m) {
        for (const std::string& name : scattering_material_names()) {
          Material named = m;
          set_substance(named, name);
          if (named == m) return name;
        }
        return std::string(kCustom);
      },
      [](Material& m, const PropertyValue& v) {
        if (std::get<std::string>(v) != kCustom) set_substance(m, std::get<std::string>(v));
      },
      std::move(names));
  // A file has at most 1e9 for each millimetre.
  list.color(
      {"subsurface.absorption", "Absorption", "1/m", 0, 1e12, 1},
      [](auto& m) -> auto& { return m.subsurface->absorption; });
  list.color(
      {"subsurface.reduced_scattering", "Reduced scattering", "1/m", 0, 1e12, 10},
      [](auto& m) -> auto& { return m.subsurface->reduced_scattering; });
  add_base_color(list);
  add_roughness(list);
  add_ior(list, MaterialType::subsurface);
}

void add_metallic_roughness(PropertyList<Material>& list) {
  add_base_color(list);
  list.number(
      {"metallic", "Metallic"}, [](auto& m) -> auto& { return m.metallic; });
  add_roughness(list);
  add_ior(list, MaterialType::metallic_roughness);
  list.number(
      {"specular", "Specular"}, [](auto& m) -> auto& { return m.specular; });
  list.color(
      {"specular_color", "Specular colour", "", 0, kMost}, [](auto& m) -> auto& { return m.specular_color; });
}

void add_common(PropertyList<Material>& list, const Material& material) {
  list.radiance(
      {"emission.color", "Emission colour"}, {"emission.strength", "Emission", "W/(m^2 sr)", 0, kMost, 0.1},
      [](auto& m) -> auto& { return m.emission; });
  if (material.normal_texture)
    list.number(
        {"normal_scale", "Strength of the normal map", "", -kMost, kMost, 0.1},
        [](auto& m) -> auto& { return m.normal_scale; });
  add_alpha(list, material.alpha_mode);
  list.toggle(
      "double_sided", "Emits on both sides", [](auto& m) -> auto& { return m.double_sided; });
  list.toggle(
      "unlit", "Unlit", [](auto& m) -> auto& { return m.unlit; });
  if (material.has_interior())
    list.add(
        PropertyKind::integer,
        {"priority", "Priority where volumes overlap", "", -kMaxPriority, kMaxPriority, 1},
        [](const Material& m) { return m.priority; },
        [](Material& m, const PropertyValue& v) { m.priority = std::get<int>(v); });
}

}  // namespace

std::vector<Property> material_properties(const Material& material) {
  PropertyList<Material> list(fresh_material());
  list.name();
  add_type(list);
  const MaterialType type = type_of(material);
  list.only_for([type](const Material& m) { return type_of(m) == type; });
  switch (type) {
    case MaterialType::metallic_roughness:
      add_metallic_roughness(list);
      break;
    case MaterialType::phong:
      add_phong(list);
      break;
    case MaterialType::conductor:
      add_conductor(list);
      break;
    case MaterialType::subsurface:
      add_subsurface(list);
  }
  list.only_for({});
  add_common(list, material);
  if (type == MaterialType::metallic_roughness || type == MaterialType::subsurface)
    add_layers(list, material, type);
  return std::move(list).take();
}

}  // namespace parian::edit
