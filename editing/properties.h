/// What an inspector shows of an element, as a table: one entry for each number, colour or choice that an
/// element of its type has, with the range that a scene and its file may have.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian::edit {

enum class PropertyKind : std::uint8_t {
  number,   // double
  angle,    // double, in degrees
  integer,  // int
  color,    // Rgb, linear; the range is that of each component
  toggle,   // bool
  choice,   // std::string, one of `choices`
  text      // std::string
};

using PropertyValue = std::variant<double, int, bool, Rgb, std::string>;

struct Property {
  std::string_view name, label, unit;  // the name is a path as "clearcoat.roughness"; unit: empty where none
  PropertyKind kind = PropertyKind::number;
  double low = 0, high = 0;  // of numbers, angles, integers and colours, both included
  double step = 0;           // what one click may change
  PropertyValue initial;     // of a new element
  std::vector<std::string> choices;
  /// Of the element of that index. Both throw UsageError where the scene has none, or none of the type that
  /// the property is for.
  std::function<PropertyValue(const Scene&, int)> get;
  /// Also throws UsageError, and leaves the scene as it was, where the value is of another type, out of
  /// range, NaN, or does not go with the rest of the element.
  std::function<void(Scene&, int, const PropertyValue&)> set;
};

// The properties of an element as it is: those of a conductor are others than those of glass, and what is on
// or off decides what follows it, so the list is to be asked for again when a toggle or a choice was set.

std::vector<Property> material_properties(const Material& material);
std::vector<Property> shape_properties(const Shape& shape);
std::vector<Property> light_properties(const Light& light);
std::vector<Property> camera_properties(const Camera& camera);
/// The index of get and set is not looked at.
std::vector<Property> environment_properties();

/// The one of that name. Throws UsageError, naming those that there are.
const Property& find_property(const std::vector<Property>& properties, std::string_view name);

}  // namespace parian::edit
