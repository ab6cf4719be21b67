/// check_fields().
#include "scene_io/gltf/file/field.h"

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "renderer/base/error.h"

namespace parian {
namespace {

using nlohmann::json;
using Kind = Field::Kind;

// Where the check stands, linked through the call stack: a path is only spelled out for an error.
struct Place {
  const Place* parent;
  const std::string* key;  // or else
  std::size_t position = 0;

  std::string path() const {
    std::vector<const Place*> steps;
    for (const Place* step = this; step->parent; step = step->parent) steps.push_back(step);
    std::string text;
    for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
      text += '/';
      text += (*step)->key ? *(*step)->key : std::to_string((*step)->position);
    }
    return text;
  }
};

class FieldCheck {
 public:
  FieldCheck(const json& document, const std::string& file) : document_(document), file_(file) {}

  /// The sizes of all arrays that indices point into, taken before anything is moved.
  void measure(const std::vector<Field>& fields) {
    for (const Field& field : fields) {
      if (!field.array.empty()) {
        const json::json_pointer pointer(field.array);
        const bool there = document_.contains(pointer) && document_.at(pointer).is_array();
        sizes_[field.array] = there ? document_.at(pointer).size() : 0;
      }
      measure(field.fields);
    }
  }

  void members(json& value, const std::vector<Field>& fields, const Place& place) {
    if (!value.is_object()) fail(place, "an object");
    json kept = json::object();
    for (const Field& field : fields) {
      const Place member{&place, &field.key};
      const auto found = value.find(field.key);
      if (found != value.end()) {
        check(*found, field, member);
        kept[field.key] = std::move(*found);
      } else if (field.is_required) {
        fail(member, describe(field));
      }
    }
    value = std::move(kept);
  }

 private:
  [[noreturn]] void fail(const Place& place, const std::string& expected) const {
    throw InputError(file_, place.path(), "expected " + expected);
  }

  std::string describe(const Field& field) const {
    switch (field.kind) {
      case Kind::object:
        return "an object";
      case Kind::list:
        return "an array of objects";
      case Kind::index:
      case Kind::index_list:
      case Kind::index_map:
      case Kind::index_map_list: {
        const std::size_t size = sizes_.at(field.array);
        return fmt::format("an index into {} ({})", field.array,
                           size ? fmt::format("0 to {}", size - 1) : "which is empty");
      }
      case Kind::integer:
      case Kind::integer_map:
        if (!field.choices.empty()) return fmt::format("one of {}", fmt::join(field.choices, ", "));
        return fmt::format("an integer from {:.0f} to {:.0f}", field.low, field.high);
      case Kind::number:
      case Kind::numbers: {
        const std::string what = field.kind == Kind::number ? "a number"
                                 : field.count == kAnyCount ? "an array of numbers, each"
                                                            : fmt::format("{} numbers, each", field.count);
        if (field.low == std::numeric_limits<float>::min()) return what + " above 0";
        if (field.low == -std::numeric_limits<float>::max()) return what + " in the range of a float";
        if (field.high == std::numeric_limits<float>::max())
          return fmt::format("{} of at least {}", what, field.low);
        return fmt::format("{} in [{}, {}]", what, field.low, field.high);
      }
      case Kind::flag:
        return "true or false";
      case Kind::text_list:
        return "an array of strings";
      case Kind::text:
        break;
    }
    return field.texts.empty() ? "a string" : fmt::format("one of \"{}\"", fmt::join(field.texts, "\", \""));
  }

  void check(json& value, const Field& field, const Place& place) {
    switch (field.kind) {
      case Kind::object:
        return members(value, field.fields, place);
      case Kind::list:
        return each(value, field, place, [&](json& v, const Place& p) { members(v, field.fields, p); });
      case Kind::index_list:
        return each(value, field, place, [&](json& v, const Place& p) { whole(v, field, p); });
      case Kind::index_map:
        return map(value, field, place);
      case Kind::integer_map:
        if (!value.is_object()) fail(place, "an object of integers");
        for (auto& [key, entry] : value.items()) whole(entry, field, Place{&place, &key});
        return;
      case Kind::index_map_list:
        return each(value, field, place, [&](json& v, const Place& p) { map(v, field, p); });
      case Kind::text_list:
        return each(value, field, place, [&](json& v, const Place& p) {
          if (!v.is_string()) fail(p, "a string");
        });
      case Kind::numbers:
        if (!value.is_array() || (field.count != kAnyCount && value.size() != field.count)) {
          fail(place, describe(field));
        }
        return each(value, field, place, [&](json& v, const Place& p) { real(v, field, p); });
      case Kind::index:
        return whole(value, field, place);
      case Kind::integer:
        return whole(value, field, place);
      case Kind::number:
        return real(value, field, place);
      case Kind::flag:
        if (!value.is_boolean()) fail(place, describe(field));
        return;
      case Kind::text:
        if (!value.is_string() ||
            (!field.texts.empty() &&
             std::ranges::find(field.texts, value.get_ref<std::string&>()) == field.texts.end())) {
          fail(place, describe(field));
        }
        return;
    }
  }

  void map(json& value, const Field& field, const Place& place) {
    if (!value.is_object()) fail(place, "an object of accessor indices");
    for (auto& [key, entry] : value.items()) whole(entry, field, Place{&place, &key});
  }

  template <class Body>
  void each(json& value, const Field& field, const Place& place, const Body& body) {
    if (!value.is_array())
      fail(place, field.kind == Kind::index_list       ? "an array of indices"
                  : field.kind == Kind::index_map_list ? "an array of objects"
                                                       : describe(field));
    for (std::size_t i = 0; i < value.size(); ++i) body(value[i], Place{&place, nullptr, i});
  }

  // Some writers print integers as 3.0: tinygltf would drop those.
  void whole(json& value, const Field& field, const Place& place) {
    const bool is_index = !field.array.empty();
    const double low = is_index ? 0 : field.low;
    const double high = is_index ? double(sizes_.at(field.array)) - 1 : field.high;
    const double number = value.is_number() ? value.get<double>() : NAN;
    const bool fits = number >= low && number <= high && number == std::floor(number);
    if (!fits ||
        (!field.choices.empty() && std::ranges::find(field.choices, number) == field.choices.end())) {
      fail(place, describe(field));
    }
    // tinygltf wants what cannot be negative unsigned.
    if (number < 0) {
      value = std::int64_t(number);
    } else {
      value = std::uint64_t(number);
    }
  }

  void real(json& value, const Field& field, const Place& place) {
    const double number = value.is_number() ? value.get<double>() : NAN;
    if (!(number >= field.low && number <= field.high)) fail(place, describe(field));
    value = number;
  }

  const json& document_;
  const std::string& file_;
  std::map<std::string, std::size_t> sizes_;
};

}  // namespace

void check_fields(json& document, const std::vector<Field>& fields, const std::string& file) {
  FieldCheck check(document, file);
  check.measure(fields);
  check.members(document, fields, Place{nullptr, nullptr});
}

}  // namespace parian
