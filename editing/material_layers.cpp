/// add_layers().
#include <utility>

#include "editing/material_properties.h"

namespace parian::edit {
namespace {

using List = PropertyList<Material>;

void add_transmission(List& list, const Material& m) {
  list.part(
      "transmission", "Transmission", [](auto& x) -> auto& { return x.transmission; });
  if (!m.transmission) return;
  list.narrow([](const Material& x) { return x.transmission.has_value(); });
  list.number(
      {"transmission.factor", "Transmission: share"},
      [](auto& x) -> auto& { return x.transmission->factor; });
}

void add_volume(List& list, const Material& m) {
  list.add(
      PropertyKind::toggle, {"volume", "Volume"}, [](const Material& x) { return x.volume.has_value(); },
      [](Material& x, const PropertyValue& v) {
        if (std::get<bool>(v) == x.volume.has_value()) return;
        x.scatter.reset();  // is the volume's
        x.volume = x.volume ? std::nullopt : std::optional<Volume>(Volume{});
      });
  if (!m.volume) return;
  list.narrow([](const Material& x) { return x.volume.has_value(); });
  list.number(
      {"volume.thickness", "Volume: thickness (0: thin walls)", "m", 0, kMost},
      [](auto& x) -> auto& { return x.volume->thickness; });
  list.color(
      {"volume.attenuation_color", "Volume: colour"},
      [](auto& x) -> auto& { return x.volume->attenuation_color; });
  list.number(
      {"volume.attenuation_distance", "Volume: colour after (0: none)", "m", 0, kMost},
      [](auto& x) -> auto& { return x.volume->attenuation_distance; });
  list.number(
      {"dispersion", "Volume: dispersion", "", 0, kMost}, [](auto& x) -> auto& { return x.dispersion; });
}

void add_scatter(List& list, const Material& m) {
  if (!m.volume) return;
  list.narrow([](const Material& x) { return x.volume && !x.subsurface; });
  list.part(
      "scatter", "Scattering", [](auto& x) -> auto& { return x.scatter; });
  if (!m.scatter) return;
  list.narrow([](const Material& x) { return x.scatter.has_value(); });
  list.color(
      {"scatter.multiscatter_color", "Scattering: colour"},
      [](auto& x) -> auto& { return x.scatter->multiscatter_color; });
  constexpr float kBelowOne = 1 - kUnitRoundoff;
  list.number(
      {"scatter.anisotropy", "Scattering: mean cosine", "", -kBelowOne, kBelowOne},
      [](auto& x) -> auto& { return x.scatter->anisotropy; });
}

void add_diffuse_transmission(List& list, const Material& m) {
  list.part(
      "diffuse_transmission", "Diffuse transmission",
      [](auto& x) -> auto& { return x.diffuse_transmission; });
  if (!m.diffuse_transmission) return;
  list.narrow([](const Material& x) { return x.diffuse_transmission.has_value(); });
  list.number(
      {"diffuse_transmission.factor", "Diffuse transmission: share"},
      [](auto& x) -> auto& { return x.diffuse_transmission->factor; });
  list.color(
      {"diffuse_transmission.color", "Diffuse transmission: colour"},
      [](auto& x) -> auto& { return x.diffuse_transmission->color; });
}

void add_clearcoat(List& list, const Material& m) {
  list.part(
      "clearcoat", "Clear coat", [](auto& x) -> auto& { return x.clearcoat; });
  if (!m.clearcoat) return;
  list.narrow([](const Material& x) { return x.clearcoat.has_value(); });
  list.number(
      {"clearcoat.factor", "Clear coat: share"}, [](auto& x) -> auto& { return x.clearcoat->factor; });
  list.number(
      {"clearcoat.roughness", "Clear coat: roughness"},
      [](auto& x) -> auto& { return x.clearcoat->roughness; });
  if (m.clearcoat->normal_texture)
    list.number(
        {"clearcoat.normal_scale", "Clear coat: strength of the normal map", "", -kMost, kMost, 0.1},
        [](auto& x) -> auto& { return x.clearcoat->normal_scale; });
}

void add_sheen(List& list, const Material& m) {
  list.part(
      "sheen", "Sheen", [](auto& x) -> auto& { return x.sheen; });
  if (!m.sheen) return;
  list.narrow([](const Material& x) { return x.sheen.has_value(); });
  list.color(
      {"sheen.color", "Sheen: colour"}, [](auto& x) -> auto& { return x.sheen->color; });
  list.number(
      {"sheen.roughness", "Sheen: roughness"}, [](auto& x) -> auto& { return x.sheen->roughness; });
}

void add_anisotropy(List& list, const Material& m) {
  list.part(
      "anisotropy", "Anisotropy", [](auto& x) -> auto& { return x.anisotropy; });
  if (!m.anisotropy) return;
  list.narrow([](const Material& x) { return x.anisotropy.has_value(); });
  list.number(
      {"anisotropy.strength", "Anisotropy: strength"},
      [](auto& x) -> auto& { return x.anisotropy->strength; });
  list.angle(
      {"anisotropy.rotation", "Anisotropy: turn from the tangent", "degrees", -360, 360, 5},
      [](auto& x) -> auto& { return x.anisotropy->rotation; });
}

void add_iridescence(List& list, const Material& m) {
  list.part(
      "iridescence", "Iridescence", [](auto& x) -> auto& { return x.iridescence; });
  if (!m.iridescence) return;
  list.narrow([](const Material& x) { return x.iridescence.has_value(); });
  list.number(
      {"iridescence.factor", "Iridescence: share"}, [](auto& x) -> auto& { return x.iridescence->factor; });
  list.number(
      {"iridescence.ior", "Iridescence: index of refraction", "", 1, kMost},
      [](auto& x) -> auto& { return x.iridescence->ior; });
  if (m.iridescence->thickness_texture)
    list.number(
        {"iridescence.thickness_minimum", "Iridescence: least thickness", "nm", 0, kMost, 10},
        [](auto& x) -> auto& { return x.iridescence->thickness_minimum; });
  list.number(
      {"iridescence.thickness_maximum", "Iridescence: thickness", "nm", 0, kMost, 10},
      [](auto& x) -> auto& { return x.iridescence->thickness_maximum; });
}

}  // namespace

void add_layers(PropertyList<Material>& list, const Material& material, MaterialType type) {
  const auto each = [&](void (*add)(List&, const Material&)) {
    list.only_for([type](const Material& m) { return type_of(m) == type; });
    add(list, material);
  };
  // A subsurface body has an inside of its own.
  if (type == MaterialType::metallic_roughness)
    for (auto* add : {add_transmission, add_volume, add_scatter, add_diffuse_transmission}) each(add);
  for (auto* add : {add_clearcoat, add_sheen, add_anisotropy, add_iridescence}) each(add);
  list.only_for({});
}

}  // namespace parian::edit
