/// A function of the distance from where light went in, as a table that is sampled exactly.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "renderer/base/distribution.h"

namespace parian {

/// One colour channel of a BSSRDF profile: R_d(r), what comes out per area at distance r of the light that
/// went in at a point of a plane. Piecewise linear between nodes at 16 places of each octave; sampled with a
/// density that is constant between them, nowhere farther than some percent from the profile itself.
class RadialProfile {
 public:
  /// Black.
  RadialProfile() = default;
  /// `profile(r)` is R_d at distance r, both in units of `unit` metres, finite for r > 0; its integral over
  /// the plane is `total`, to which the table is scaled. The farthest 1e-4 of that are cut off.
  RadialProfile(const std::function<double(double)>& profile, double unit, double total);

  /// R_d, per square metre, at a distance in metres; 0 from max_radius() on.
  float eval(float r) const {
    const float x = r * inverse_unit_;
    if (!(x < end_)) return 0;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(std::max(x, kFirst)) - kFirstBits;
    const std::size_t i = bits >> kShift;
    const float fraction = float(bits & ((1u << kShift) - 1)) * (1.0f / (1u << kShift));
    return values_[i] + (values_[i + 1] - values_[i]) * fraction;
  }
  /// The density, per square metre of the plane, with which sample() finds a point at a distance in metres.
  float pdf(float r) const {
    const float x = r * inverse_unit_;
    if (!(x < end_)) return 0;
    if (x < kFirst) return densities_[0];
    return densities_[((std::bit_cast<std::uint32_t>(x) - kFirstBits) >> kShift) + 1];
  }
  /// A distance in metres for u in [0, 1); the profile must not be black.
  float sample(float u) const;
  /// The integral of eval() over the plane.
  float total() const { return total_; }
  float max_radius() const { return end_ * unit_; }

 private:
  static constexpr int kShift = 19;                           // leaves 4 bits of the mantissa
  static constexpr float kFirst = 0x1p-12f, kLast = 0x1p14f;  // in units
  static constexpr std::uint32_t kFirstBits = std::bit_cast<std::uint32_t>(kFirst);

  /// The node's place.
  static float node(std::size_t i) { return std::bit_cast<float>(kFirstBits + (std::uint32_t(i) << kShift)); }

  float unit_ = 1, inverse_unit_ = 1, end_ = 0, total_ = 0;
  std::vector<float> values_;     // at the nodes
  std::vector<float> densities_;  // inside the first node, and between each and the next
  Distribution1D cells_;          // the same, as probabilities
};

}  // namespace parian
