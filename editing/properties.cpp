#include "editing/properties.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "editing/property_list.h"

namespace parian::edit {
namespace {

[[noreturn]] void refuse_for(const Property& property, const std::string& expected) {
  refuse(fmt::format("{}: expected {}", property.label, expected));
}

void check_number(const Property& p, const char* what, double value) {
  if (value >= p.low && value <= p.high) return;  // false for NaN
  const std::string unit = p.unit.empty() ? "" : fmt::format(", in {}", p.unit);
  if (p.low == kAboveZero && p.high == kMost)
    refuse_for(p, fmt::format("{} above 0{}, not {}", what, unit, value));
  if (p.low == -kMost && p.high == kMost) refuse_for(p, fmt::format("{}{}, not {}", what, unit, value));
  if (p.high == kMost) refuse_for(p, fmt::format("{} of at least {}{}, not {}", what, p.low, unit, value));
  refuse_for(p, fmt::format("{} from {} to {}{}, not {}", what, p.low, p.high, unit, value));
}

template <class T>
const T& get_as(const Property& p, const PropertyValue& value, const char* what) {
  const T* held = std::get_if<T>(&value);
  if (!held) refuse_for(p, what);
  return *held;
}

}  // namespace

void check_value(const Property& p, const PropertyValue& value) {
  switch (p.kind) {
    case PropertyKind::number:
      return check_number(p, "a number", get_as<double>(p, value, "a number"));
    case PropertyKind::angle:
      return check_number(p, "an angle", get_as<double>(p, value, "an angle, in degrees"));
    case PropertyKind::integer:
      return check_number(p, "an integer", get_as<int>(p, value, "an integer"));
    case PropertyKind::color: {
      const Rgb& color = get_as<Rgb>(p, value, "a colour");
      for (const float component : {color.x, color.y, color.z}) check_number(p, "components", component);
      return;
    }
    case PropertyKind::toggle:
      get_as<bool>(p, value, "true or false");
      return;
    case PropertyKind::choice: {
      const std::string& chosen = get_as<std::string>(p, value, "a name");
      if (std::ranges::find(p.choices, chosen) == p.choices.end())
        refuse_for(p, fmt::format("one of {}, not {}", fmt::join(p.choices, ", "), chosen));
      return;
    }
    case PropertyKind::text:
      get_as<std::string>(p, value, "a text");
  }
}

const Property& find_property(const std::vector<Property>& properties, std::string_view name) {
  const auto found = std::ranges::find(properties, name, &Property::name);
  if (found != properties.end()) return *found;
  std::vector<std::string_view> names;
  for (const Property& property : properties) names.push_back(property.name);
  refuse(fmt::format("property: expected one of {}, not {}", fmt::join(names, ", "), name));
}

}  // namespace parian::edit
