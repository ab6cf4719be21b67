/// The values of an animation between its key frames (glTF 2.0, appendix C).
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/base/shared_array.h"

namespace parian {

enum class Interpolation { step, linear, cubic_spline };

/// Keys of one property, whose values have `width` components each.
struct Keyframes {
  Interpolation interpolation = Interpolation::linear;
  bool rotation = false;  // the values are quaternions: x, y, z, w
  std::size_t width = 0;
  SharedArray<float> times;   // seconds, rising; at least one
  SharedArray<float> values;  // one for each key; for splines three: tangent in, value, tangent out
};

/// The value at a time, before the first key and after the last that of those. Rotations are of unit length,
/// or zero where that cannot be.
std::vector<float> sample(const Keyframes& keys, double seconds);

}  // namespace parian
