/// A function of the distance from where light went in, as a table that is sampled exactly.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <vector>

#include "renderer/base/distribution.h"

namespace parian {

/// One colour channel of a BSSRDF profile: R_d(r), what comes out per area at distance r of the light that
/// went in at a point of a plane. Piecewise linear between nodes at 32 places of each octave; sampled with a
/// density that is constant between them, and nowhere farther than some percent from the profile itself.
class RadialProfile {
 public:
  /// Black.
  RadialProfile() = default;
  /// `profile(r)` is R_d at distance r, both in units of `unit` metres, finite for r > 0 and about constant
  /// below 2^-12; its integral over the plane is `total`, to which the table is scaled. The farthest 1e-4 of
  /// that are cut off, and what is beyond 2^14 units.
  RadialProfile(const std::function<double(double)>& profile, double unit, double total);

  /// R_d, per square metre, at a distance in metres; 0 from max_radius() on.
  float eval(float r) const {
    const float x = r * inverse_unit_;
    if (!(x < end_)) return 0;
    const std::uint32_t place = std::bit_cast<std::uint32_t>(std::max(x, kFirst)) - kFirstBits;
    const float* const v = values_.data() + (place >> kShift);
    return v[0] + (v[1] - v[0]) * (float(place & ((1u << kShift) - 1)) * (1.0f / (1u << kShift)));
  }
  /// The density, per square metre of the plane, with which sample() finds a point at a distance in metres.
  float pdf(float r) const {
    const float x = r * inverse_unit_;
    if (!(x < end_)) return 0;
    return densities_[x < kFirst ? 0 : cell_of(x) + 1];
  }
  /// A distance in metres for u in [0, 1); 0 where all is black.
  float sample(float u) const;
  /// The integral of eval() over the plane.
  float total() const { return total_; }
  /// Metres.
  float max_radius() const { return end_ * unit_; }

 private:
  static constexpr int kShift = 18;                           // leaves 5 bits of the mantissa
  static constexpr float kFirst = 0x1p-12f, kLast = 0x1p14f;  // in units
  static constexpr std::uint32_t kFirstBits = std::bit_cast<std::uint32_t>(kFirst);

  /// The node's place, in units.
  static float node(std::size_t i) { return std::bit_cast<float>(kFirstBits + (std::uint32_t(i) << kShift)); }
  static std::size_t cell_of(float x) { return (std::bit_cast<std::uint32_t>(x) - kFirstBits) >> kShift; }
  static float inner_radius(std::size_t ring) { return ring == 0 ? 0 : node(ring - 1); }

  float unit_ = 1, inverse_unit_ = 1;
  float end_ = 0;  // in units
  float total_ = 0;
  std::vector<float> values_;     // at the nodes
  std::vector<float> densities_;  // inside the first node, and from each to the next
  Distribution1D cells_;          // the same, as probabilities
};

}  // namespace parian
