/// Makes the properties of one type of element out of what reaches their values.
#pragma once

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "editing/arguments.h"
#include "editing/properties.h"

namespace parian::edit {

inline constexpr double kMost = std::numeric_limits<float>::max();
inline constexpr double kAboveZero = std::numeric_limits<float>::min();
inline constexpr double kDegrees = 180 / std::numbers::pi;

/// Throws UsageError unless the value is what the property's kind, range and choices ask for.
void check_value(const Property& property, const PropertyValue& value);

// The element of that index, in a scene const or not.
template <class AnyScene>
auto& element_at(AnyScene& scene, int index, const Material*) {
  check_index(index, scene.materials.size(), "material");
  return scene.materials[std::size_t(index)];
}
template <class AnyScene>
auto& element_at(AnyScene& scene, int index, const Shape*) {
  check_index(index, scene.shapes.size(), "shape");
  return scene.shapes[std::size_t(index)];
}
template <class AnyScene>
auto& element_at(AnyScene& scene, int index, const Light*) {
  check_index(index, scene.lights.size(), "light");
  return scene.lights[std::size_t(index)];
}
template <class AnyScene>
auto& element_at(AnyScene& scene, int index, const Camera*) {
  check_index(index, scene.cameras.size(), "camera");
  return scene.cameras[std::size_t(index)];
}
template <class AnyScene>
auto& element_at(AnyScene& scene, int, const Environment*) {
  return scene.environment;
}

/// What a property is called, and the range of its numbers.
struct Spec {
  const char *name, *label, *unit = "";
  double low = 0, high = 1, step = 0.01;
};

/// Accessors are generic lambdas that return a reference to the value in an element, const or not.
template <class Element>
class PropertyList {
 public:
  using Applies = std::function<bool(const Element&)>;
  using Get = std::function<PropertyValue(const Element&)>;
  using Put = std::function<void(Element&, const PropertyValue&)>;

  /// `fresh`: a new element that has all that the properties reach.
  explicit PropertyList(Element fresh) : fresh_(std::move(fresh)) {}

  /// The properties that follow are for elements for which this holds.
  void only_for(Applies applies) { applies_ = std::move(applies); }
  /// The same, of those of which it was said before.
  void narrow(Applies more) {
    applies_ = [before = applies_, more](const Element& e) { return (!before || before(e)) && more(e); };
  }

  /// The general case: `put` is called with a value that fits the kind and the range, on a copy, and may
  /// refuse it.
  void add(PropertyKind kind, const Spec& spec, Get get, Put put, std::vector<std::string> choices = {}) {
    Property p;
    p.name = spec.name, p.label = spec.label, p.unit = spec.unit;
    p.kind = kind;
    p.low = spec.low, p.high = spec.high, p.step = spec.step;
    p.initial = get(fresh_);
    p.choices = std::move(choices);
    const auto check = [applies = applies_, label = spec.label](const Element& element) {
      if (applies && !applies(element)) refuse(fmt::format("{}: expected an element that has it", label));
    };
    p.get = [check, get](const Scene& scene, int index) {
      const Element& element = element_at(scene, index, static_cast<const Element*>(nullptr));
      check(element);
      return get(element);
    };
    p.set = [check, put, range = p](Scene& scene, int index, const PropertyValue& value) {
      Element& element = element_at(scene, index, static_cast<const Element*>(nullptr));
      check(element);
      check_value(range, value);
      Element edited = element;
      put(edited, value);
      check_element(edited);
      element = std::move(edited);
    };
    properties_.push_back(std::move(p));
  }

  template <class Access>
  void number(const Spec& spec, const Access& access) {
    add(
        PropertyKind::number, spec, [access](const Element& e) { return double(access(e)); },
        [access](Element& e, const PropertyValue& v) { access(e) = float(std::get<double>(v)); });
  }
  /// The element has radians; the range is in degrees.
  template <class Access>
  void angle(const Spec& spec, const Access& access) {
    add(
        PropertyKind::angle, spec, [access](const Element& e) { return access(e) * kDegrees; },
        [access](Element& e, const PropertyValue& v) { access(e) = float(std::get<double>(v) / kDegrees); });
  }
  template <class Access>
  void color(const Spec& spec, const Access& access) {
    add(
        PropertyKind::color, spec, [access](const Element& e) { return access(e); },
        [access](Element& e, const PropertyValue& v) { access(e) = std::get<Rgb>(v); });
  }
  template <class Access>
  void toggle(const char* name, const char* label, const Access& access) {
    add(
        PropertyKind::toggle, {name, label}, [access](const Element& e) { return access(e); },
        [access](Element& e, const PropertyValue& v) { access(e) = std::get<bool>(v); });
  }
  /// Whether an optional part is there; a new one has the values of its struct.
  template <class Access>
  void part(const char* name, const char* label, const Access& access) {
    add(
        PropertyKind::toggle, {name, label}, [access](const Element& e) { return access(e).has_value(); },
        [access](Element& e, const PropertyValue& v) {
          auto& optional = access(e);
          if (std::get<bool>(v) == optional.has_value()) return;
          if (optional)
            optional.reset();
          else
            optional.emplace();
        });
  }
  void name() {
    add(
        PropertyKind::text, {"name", "Name"}, [](const Element& e) { return e.name; },
        [](Element& e, const PropertyValue& v) { e.name = std::get<std::string>(v); });
  }
  /// A colour that has a strength in it, as that of its brightest component: the two as apart.
  template <class Access>
  void radiance(const Spec& color, const Spec& strength, const Access& access) {
    const auto brightest = [](const Rgb& c) { return std::max({c.x, c.y, c.z}); };
    add(
        PropertyKind::color, color,
        [access, brightest](const Element& e) {
          const Rgb c = access(e);
          return is_black(c) ? c : c / brightest(c);
        },
        [access, brightest](Element& e, const PropertyValue& v) {
          Rgb& c = access(e);
          c = std::get<Rgb>(v) * (is_black(c) ? 1 : brightest(c));
        });
    add(
        PropertyKind::number, strength,
        [access, brightest](const Element& e) { return double(brightest(access(e))); },
        [access, brightest](Element& e, const PropertyValue& v) {
          Rgb& c = access(e);
          c = (is_black(c) ? Rgb(1) : c / brightest(c)) * float(std::get<double>(v));
        });
  }

  std::vector<Property> take() && { return std::move(properties_); }

 private:
  Element fresh_;
  Applies applies_;
  std::vector<Property> properties_;
};

}  // namespace parian::edit
