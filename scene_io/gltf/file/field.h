/// A small schema language: what one member of a JSON object must be, and the check of a document against it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <limits>
#include <string>
#include <vector>

namespace parian {

/// For numbers(): an array of any length.
inline constexpr std::size_t kAnyCount = std::size_t(-1);

/// One member. Made by the functions below, which read as sentences: number("range").positive().
struct Field {
  enum class Kind {
    object,
    list,
    index,
    index_list,
    index_map,
    integer_map,
    index_map_list,
    integer,
    number,
    numbers,
    flag,
    text,
    text_list
  };
  std::string key;
  Kind kind = Kind::object;
  double low = -std::numeric_limits<float>::max(), high = std::numeric_limits<float>::max();
  std::size_t count = 0;                // numbers: how many, any if kAnyCount
  std::string array = {};               // index kinds: JSON pointer of the array they point into
  std::vector<std::string> texts = {};  // text: the choices, all if empty
  std::vector<int> choices = {};        // integer: the choices, all in [low, high] if empty
  std::vector<Field> fields = {};       // object, list of objects: their members
  bool is_required = false;

  Field required() &&;
  Field between(double a, double b) &&;
  Field at_least(double a) &&;
  /// Above zero by a normal float.
  Field positive() &&;
};

Field object(std::string key, std::vector<Field> fields);
Field list(std::string key, std::vector<Field> fields);
Field index(std::string key, std::string array);
Field indices(std::string key, std::string array);
Field index_map(std::string key, std::string array);
Field index_maps(std::string key, std::string array);
/// In [0, 2^53], where a double counts exactly, unless said otherwise.
Field integer(std::string key);
Field integer_map(std::string key);
Field choice(std::string key, std::vector<int> choices);
/// Finite as a float, unless said otherwise.
Field number(std::string key);
Field numbers(std::string key, std::size_t count);
Field flag(std::string key);
Field text(std::string key, std::vector<std::string> choices = {});
Field texts(std::string key);

/// Checks `document` (an object with these members) and removes every member that is not named. Throws
/// InputError.
void check_fields(nlohmann::json& document, const std::vector<Field>& fields, const std::string& file);

}  // namespace parian
