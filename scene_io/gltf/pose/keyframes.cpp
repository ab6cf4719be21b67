#include "scene_io/gltf/pose/keyframes.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace parian {
namespace {

using Values = std::vector<double>;

/// What lies at `key`: of a spline part 0 is its tangent in, 1 its value, 2 its tangent out.
std::span<const float> values_at(const Keyframes& keys, std::size_t key, std::size_t part = 1) {
  if (keys.interpolation == Interpolation::cubic_spline) key = 3 * key + part;
  return {keys.values.data() + key * keys.width, keys.width};
}

double dot(const Values& a, const Values& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void make_unit(Values& v) {
  const double length = std::sqrt(dot(v, v));
  for (double& x : v) x = length > 0 ? x / length : 0;
}

Values to_values(std::span<const float> stored, bool rotation) {
  Values values(stored.begin(), stored.end());
  if (rotation) make_unit(values);
  return values;
}

/// a (1 - t) + b t; of rotations along the shorter arc between them.
Values interpolate_linearly(const Values& a, const Values& b, double t, bool rotation) {
  double of_a = 1 - t, of_b = t;
  if (rotation) {
    const double cosine = dot(a, b), angle = std::acos(std::min(std::abs(cosine), 1.0));
    constexpr double kSmallest = 1e-6;  // radians; below it the arc is straight to the last bit
    if (angle > kSmallest) {
      of_a = std::sin(angle * (1 - t)) / std::sin(angle);
      of_b = std::sin(angle * t) / std::sin(angle);
    }
    if (cosine < 0) of_b = -of_b;
  }
  Values result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = of_a * a[i] + of_b * b[i];
  return result;
}

/// The cubic Hermite spline from key k to the next, which is `duration` later.
Values interpolate_by_spline(const Keyframes& keys, std::size_t k, double t, double duration) {
  const auto v0 = values_at(keys, k), out0 = values_at(keys, k, 2);
  const auto v1 = values_at(keys, k + 1), in1 = values_at(keys, k + 1, 0);
  const double t2 = t * t, t3 = t2 * t;
  Values result(keys.width);
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = (2 * t3 - 3 * t2 + 1) * v0[i] + duration * (t3 - 2 * t2 + t) * out0[i] +
                (3 * t2 - 2 * t3) * v1[i] + duration * (t3 - t2) * in1[i];
  }
  return result;
}

}  // namespace

std::vector<float> sample(const Keyframes& keys, double seconds) {
  const auto next = std::size_t(std::ranges::upper_bound(keys.times, seconds) - keys.times.begin());
  const std::size_t k = next == 0 ? 0 : next - 1;
  Values result;
  if (next == 0 || next == keys.times.size() || keys.times[k] == seconds ||
      keys.interpolation == Interpolation::step) {
    result = to_values(values_at(keys, k), keys.rotation);
  } else {
    const double duration = double(keys.times[next]) - keys.times[k];
    const double t = (seconds - keys.times[k]) / duration;
    result = keys.interpolation == Interpolation::cubic_spline
                 ? interpolate_by_spline(keys, k, t, duration)
                 : interpolate_linearly(to_values(values_at(keys, k), keys.rotation),
                                        to_values(values_at(keys, next), keys.rotation), t, keys.rotation);
  }
  if (keys.rotation) make_unit(result);
  return {result.begin(), result.end()};
}

}  // namespace parian
