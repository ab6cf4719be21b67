/// Values of the scene as members of JSON objects.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <string>

#include "renderer/scene/scene.h"

namespace parian {

/// A number that reads back as the same float, with as few digits as that takes.
inline nlohmann::json to_json(float value) {
  const double shortest = std::strtod(fmt::format("{}", value).c_str(), nullptr);
  if (float(shortest) != value) return double(value);
  // Whole numbers are written as such, but for the negative zero, which is none.
  const bool is_whole = std::abs(shortest) < 1e6 && shortest == double(long(shortest));
  if (is_whole && (shortest != 0 || !std::signbit(shortest))) return long(shortest);
  return shortest;
}
inline nlohmann::json to_json(double value) { return value; }
inline nlohmann::json to_json(int value) { return value; }
inline nlohmann::json to_json(bool value) { return value; }
inline nlohmann::json to_json(const std::string& value) { return value; }
inline nlohmann::json to_json(const Vec3f& v) {
  return nlohmann::json::array({to_json(v.x), to_json(v.y), to_json(v.z)});
}
inline nlohmann::json to_json(const Quatf& q) {
  return nlohmann::json::array({to_json(q.v.x), to_json(q.v.y), to_json(q.v.z), to_json(q.r)});
}

/// The member, only where its value is not what the file has: so that the file keeps the words it has.
template <class T>
void set_changed(nlohmann::json& object, const char* key, const T& now, const T& before) {
  if (!(now == before)) object[key] = to_json(now);
}

/// The same for members that are left out where they have a value that says nothing.
template <class T>
void set_or_erase(nlohmann::json& object, const char* key, const T& now, const T& before, const T& nothing) {
  if (now == before) return;
  if (now == nothing)
    object.erase(key);
  else
    object[key] = to_json(now);
}

inline void set_name(nlohmann::json& object, const std::string& now, const std::string& before) {
  set_or_erase(object, "name", now, before, std::string());
}

/// An extension of an element, made where it is missing.
inline nlohmann::json& need_extension(nlohmann::json& element, const char* name) {
  nlohmann::json& found = element["extensions"][name];
  if (!found.is_object()) found = nlohmann::json::object();
  return found;
}

/// Without an object of extensions where there is none left.
inline void erase_extension(nlohmann::json& element, const char* name) {
  const auto extensions = element.find("extensions");
  if (extensions == element.end() || extensions->erase(name) == 0) return;
  if (extensions->empty()) element.erase(extensions);
}

inline nlohmann::json* find_extension(nlohmann::json& element, const char* name) {
  const auto extensions = element.find("extensions");
  if (extensions == element.end() || !extensions->contains(name)) return nullptr;
  return &(*extensions)[name];
}

}  // namespace parian
