/// The classical dipole by hand, for tests: what lies within a radius has a closed form.
#pragma once

#include <cmath>

namespace parian {

/// Jensen et al. 2001, in units of the reduced mean free path, of index 1.3.
struct DipoleByHand {
  double albedo;
  static constexpr double kInside = 0.4444567;  // Fresnel's reflectance of diffuse light from inside
  static constexpr double kImage = 1 + 4.0 / 3 * (1 + kInside) / (1 - kInside);

  double falloff() const { return std::sqrt(3 * (1 - albedo)); }
  double total() const { return albedo / 2 * (std::exp(-falloff()) + std::exp(-falloff() * kImage)); }
  /// The share of the total that comes out farther than r from where it went in.
  double beyond(double r) const {
    double out = 0;
    for (const double z : {1.0, kImage}) {
      const double d = std::hypot(r, z);
      out += z * std::exp(-falloff() * d) / d;
    }
    return albedo / 2 * out / total();
  }
};

}  // namespace parian
