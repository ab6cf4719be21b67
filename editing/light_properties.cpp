/// light_properties().
#include <array>
#include <utility>

#include "editing/property_list.h"

namespace parian::edit {
namespace {

constexpr std::array<const char*, 5> kKinds = {"point", "spot", "directional", "rectangle", "disk"};

const char* intensity_unit(LightKind kind) {
  if (kind == LightKind::point || kind == LightKind::spot) return "W/sr";
  return kind == LightKind::directional ? "W/m^2" : "W/(m^2 sr)";
}

/// What the other kind needs and this light may not have, since validate() asks it only of that kind.
void set_kind(Light& light, LightKind kind) {
  const Light fresh;
  light.kind = kind;
  if (!(light.outer_angle > 0 && light.outer_angle <= kPi / 2 && light.inner_angle >= 0 &&
        light.inner_angle < light.outer_angle))
    light.inner_angle = fresh.inner_angle, light.outer_angle = fresh.outer_angle;
  if (!(light.width > 0) || !std::isfinite(light.width)) light.width = fresh.width;
  if (kind == LightKind::disk || !(light.height > 0) || !std::isfinite(light.height))
    light.height = light.width;
}

void add_kind(PropertyList<Light>& list) {
  const std::vector<std::string> choices(kKinds.begin(), kKinds.end());
  list.add(
      PropertyKind::choice, {"kind", "Kind"},
      [](const Light& l) { return std::string(kKinds[std::size_t(l.kind)]); },
      [choices](Light& l, const PropertyValue& v) {
        const auto at = std::find(choices.begin(), choices.end(), std::get<std::string>(v));
        set_kind(l, LightKind(at - choices.begin()));
      },
      choices);
}

/// Half angles from the axis. The inner one stays below the outer.
void add_cone(PropertyList<Light>& list) {
  const auto check = [](const Light& l, const char* label, const char* which, float other) {
    if (!(l.inner_angle < l.outer_angle))
      refuse(fmt::format("{}: expected an angle {} one, {} degrees", label, which, float(other * kDegrees)));
  };
  list.add(
      PropertyKind::angle, {"inner_angle", "Inner half angle", "degrees", 0, 90, 1},
      [](const Light& l) { return l.inner_angle * kDegrees; },
      [check](Light& l, const PropertyValue& v) {
        l.inner_angle = float(std::get<double>(v) / kDegrees);
        check(l, "Inner half angle", "below the outer", l.outer_angle);
      });
  list.add(
      PropertyKind::angle, {"outer_angle", "Outer half angle", "degrees", kAboveZero, 90, 1},
      [](const Light& l) { return l.outer_angle * kDegrees; },
      [check](Light& l, const PropertyValue& v) {
        l.outer_angle = std::min(float(std::get<double>(v) / kDegrees), kPi / 2);
        check(l, "Outer half angle", "above the inner", l.inner_angle);
      });
}

void add_size(PropertyList<Light>& list, LightKind kind) {
  const auto length = [](const char* name, const char* label) {
    return Spec{name, label, "m", kAboveZero, kMost, 0.05};
  };
  if (kind == LightKind::disk) {
    list.add(
        PropertyKind::number, length("diameter", "Diameter"), [](const Light& l) { return double(l.width); },
        [](Light& l, const PropertyValue& v) { l.width = l.height = float(std::get<double>(v)); });
    return;
  }
  list.number(
      length("width", "Width"), [](auto& l) -> auto& { return l.width; });
  list.number(
      length("height", "Height"), [](auto& l) -> auto& { return l.height; });
}

}  // namespace

std::vector<Property> light_properties(const Light& light) {
  const LightKind kind = light.kind;
  PropertyList<Light> list(Light{});
  list.name();
  add_kind(list);
  list.color(
      {"color", "Colour", "", 0, kMost}, [](auto& l) -> auto& { return l.color; });
  list.only_for([kind](const Light& l) { return l.kind == kind; });
  list.number(
      {"intensity", "Intensity", intensity_unit(kind), 0, kMost, 0.1},
      [](auto& l) -> auto& { return l.intensity; });
  if (kind == LightKind::point || kind == LightKind::spot)
    list.number(
        {"range", "Range (0: none)", "m", 0, kMost, 0.1}, [](auto& l) -> auto& { return l.range; });
  if (kind == LightKind::spot) add_cone(list);
  if (kind == LightKind::rectangle || kind == LightKind::disk) add_size(list, kind);
  return std::move(list).take();
}

}  // namespace parian::edit
