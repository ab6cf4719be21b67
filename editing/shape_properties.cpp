/// shape_properties().
#include <algorithm>

#include "editing/property_list.h"

namespace parian::edit {
namespace {

constexpr const char* kMetres = "m";

Spec length(const char* name, const char* label) { return {name, label, kMetres, kAboveZero, kMost, 0.05}; }

/// One of the radii of a cylinder, of which one at most may be 0.
template <class Access, class Other>
void add_radius(PropertyList<Shape>& list, const char* name, const char* label, const Access& access,
                const Other& other) {
  list.add(
      PropertyKind::number, {name, label, kMetres, 0, kMost, 0.05},
      [access](const Shape& s) { return double(access(s)); },
      [access, other, label](Shape& s, const PropertyValue& v) {
        access(s) = float(std::get<double>(v));
        if (access(s) == 0 && other(s) == 0)
          refuse(fmt::format("{}: expected a number above 0, in m, since the other radius is 0", label));
      });
}

}  // namespace

std::vector<Property> shape_properties(const Shape& shape) {
  PropertyList<Shape> list(Shape{});
  list.name();
  list.only_for([kind = shape.kind](const Shape& s) { return s.kind == kind; });
  const auto bottom = [](auto& s) -> auto& { return s.radius_bottom; };
  const auto top = [](auto& s) -> auto& { return s.radius_top; };
  switch (shape.kind) {
    case ShapeKind::sphere:
      list.number(
          length("radius", "Radius"), [](auto& s) -> auto& { return s.radius; });
      break;
    case ShapeKind::cylinder:
      add_radius(list, "radius_bottom", "Radius at the bottom", bottom, top);
      add_radius(list, "radius_top", "Radius at the top", top, bottom);
      list.number(
          length("height", "Height"), [](auto& s) -> auto& { return s.height; });
      break;
    case ShapeKind::box:
    case ShapeKind::plane:
      list.number(
          length("size.x", "Size along x"), [](auto& s) -> auto& { return s.size.x; });
      if (shape.kind == ShapeKind::box)
        list.number(
            length("size.y", "Size along y"), [](auto& s) -> auto& { return s.size.y; });
      list.number(
          length("size.z", "Size along z"), [](auto& s) -> auto& { return s.size.z; });
  }
  return std::move(list).take();
}

}  // namespace parian::edit
