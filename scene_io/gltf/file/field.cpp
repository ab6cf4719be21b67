#include "scene_io/gltf/file/field.h"

#include <utility>

namespace parian {

using Kind = Field::Kind;

constexpr double kExactIntegers = 9007199254740992.0;  // 2^53

Field Field::required() && {
  is_required = true;
  return std::move(*this);
}
Field Field::between(double a, double b) && {
  low = a;
  high = b;
  return std::move(*this);
}
Field Field::at_least(double a) && {
  low = a;
  return std::move(*this);
}
Field Field::positive() && {
  low = std::numeric_limits<float>::min();
  return std::move(*this);
}

Field object(std::string key, std::vector<Field> fields) {
  return {.key = std::move(key), .kind = Kind::object, .fields = std::move(fields)};
}
Field list(std::string key, std::vector<Field> fields) {
  return {.key = std::move(key), .kind = Kind::list, .fields = std::move(fields)};
}
Field index(std::string key, std::string array) {
  return {.key = std::move(key), .kind = Kind::index, .array = std::move(array)};
}
Field indices(std::string key, std::string array) {
  return {.key = std::move(key), .kind = Kind::index_list, .array = std::move(array)};
}
Field index_map(std::string key, std::string array) {
  return {.key = std::move(key), .kind = Kind::index_map, .array = std::move(array)};
}
Field index_maps(std::string key, std::string array) {
  return {.key = std::move(key), .kind = Kind::index_map_list, .array = std::move(array)};
}
Field integer(std::string key) {
  return {.key = std::move(key), .kind = Kind::integer, .low = 0, .high = kExactIntegers};
}
Field integer_map(std::string key) {
  return {.key = std::move(key), .kind = Kind::integer_map, .low = 0, .high = kExactIntegers};
}
Field choice(std::string key, std::vector<int> choices) {
  return {.key = std::move(key),
          .kind = Kind::integer,
          .low = 0,
          .high = kExactIntegers,
          .choices = std::move(choices)};
}
Field number(std::string key) { return {.key = std::move(key), .kind = Kind::number}; }
Field numbers(std::string key, std::size_t count) {
  return {.key = std::move(key), .kind = Kind::numbers, .count = count};
}
Field flag(std::string key) { return {.key = std::move(key), .kind = Kind::flag}; }
Field text(std::string key, std::vector<std::string> choices) {
  return {.key = std::move(key), .kind = Kind::text, .texts = std::move(choices)};
}
Field texts(std::string key) { return {.key = std::move(key), .kind = Kind::text_list}; }

}  // namespace parian
