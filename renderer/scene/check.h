/// The checks that validate() is made of.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/scene/scene.h"

namespace parian {

/// Each member throws InputError, naming the file and `where`, unless the value is as its name says; none
/// accepts NaN.
class Check {
 public:
  explicit Check(const std::string& file) : file_(file) {}

  [[noreturn]] void fail(const std::string& where, std::string_view expected) const {
    throw InputError(file_, where, expected);
  }

  template <class T, class Body>
  void each(const char* name, const std::vector<T>& items, const Body& body) const {
    for (std::size_t i = 0; i < items.size(); ++i) body(items[i], fmt::format("/{}/{}", name, i));
  }

  void index(int value, std::size_t size, const std::string& where) const {
    if (value < 0 || std::size_t(value) >= size)
      fail(where, fmt::format("expected an index below {}, not {}", size, value));
  }

  void optional_index(int value, std::size_t size, const std::string& where) const {
    if (value != kNone) index(value, size, where);
  }

  void range(float value, float low, float high, const std::string& where) const {
    if (value >= low && value <= high) return;  // false for NaN
    if (low == std::numeric_limits<float>::min())
      fail(where, fmt::format("expected a number above 0, not {}", value));
    if (high == std::numeric_limits<float>::max())
      fail(where, fmt::format("expected a number of at least {}, not {}", low, value));
    fail(where, fmt::format("expected a number in [{}, {}], not {}", low, high, value));
  }
  void finite(float value, const std::string& where) const {
    if (!std::isfinite(value)) fail(where, fmt::format("expected a finite number, not {}", value));
  }
  void positive(float value, const std::string& where) const {
    range(value, std::numeric_limits<float>::min(), std::numeric_limits<float>::max(), where);
  }
  void not_negative(float value, const std::string& where) const {
    range(value, 0, std::numeric_limits<float>::max(), where);
  }
  void color(const Rgb& color, float high, const std::string& where) const {
    for (const float value : {color.x, color.y, color.z}) range(value, 0, high, where);
  }

  /// Unit but for what rounding to float leaves.
  void rotation(const Quatf& q, const std::string& where) const {
    if (!is_rotation(q)) fail(where, "expected a unit quaternion");
  }

  static bool is_rotation(const Quatf& q) { return std::abs(q.r * q.r + q.v.dot(q.v) - 1) <= kUnitTolerance; }

  static bool is_unit(const Vec3f& v) { return std::abs(v.dot(v) - 1) <= kUnitTolerance; }

 private:
  static constexpr float kUnitTolerance = 1e-3f;  // of a squared length

  const std::string& file_;
};

/// The parts of validate(): all materials, all meshes, and all nodes with the forest that they form.
void validate_materials(const Scene& scene, const Check& check);
void validate_meshes(const Scene& scene, const Check& check);
void validate_nodes(const Scene& scene, const Check& check);

}  // namespace parian
