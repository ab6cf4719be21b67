/// A random walk below the surface of a half-space, by itself: nothing of the code under test.
#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <random>

namespace parian {

/// Walks of light that went in at the origin along the normal, in units of the mean free path: isotropic
/// scattering, below a smooth interface of relative index eta.
class HalfSpaceWalk {
 public:
  HalfSpaceWalk(double albedo, double eta, std::uint32_t seed) : albedo_(albedo), eta_(eta), random_(seed) {}

  /// How far from the origin the next one comes out; nothing where it is absorbed.
  std::optional<double> next() {
    double x = 0, y = 0, z = 0, dx = 0, dy = 0, dz = 1;  // z is the depth
    for (;;) {
      double path = -std::log1p(-uniform());
      while (z + path * dz < 0) {
        const double to_surface = -z / dz;
        x += to_surface * dx;
        y += to_surface * dy;
        z = 0;
        if (uniform() >= reflectance(-dz)) return std::hypot(x, y);
        path -= to_surface;
        dz = -dz;
      }
      x += path * dx;
      y += path * dy;
      z += path * dz;
      if (uniform() >= albedo_) return std::nullopt;
      dz = 2 * uniform() - 1;
      const double phi = 2 * std::numbers::pi * uniform(), sine = std::sqrt(1 - dz * dz);
      dx = sine * std::cos(phi);
      dy = sine * std::sin(phi);
    }
  }

 private:
  double uniform() { return std::ldexp(double(random_()), -32); }
  /// Fresnel's, from inside.
  double reflectance(double cosine) const {
    const double sine2 = eta_ * eta_ * (1 - cosine * cosine);
    if (sine2 >= 1) return 1;
    const double t = std::sqrt(1 - sine2);
    const double s = (eta_ * cosine - t) / (eta_ * cosine + t), p = (cosine - eta_ * t) / (cosine + eta_ * t);
    return (s * s + p * p) / 2;
  }

  double albedo_, eta_;
  std::mt19937 random_;
};

}  // namespace parian
