/// Homogeneous volumes inside closed surfaces, and which of them a ray is in.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/scene/scene.h"

namespace parian {

/// What is inside a surface whose material has an interior.
struct Medium {
  float ior;         // at the d line, 587.6 nm; against vacuum
  float dispersion;  // 20 over the Abbe number; 0: all wavelengths alike
  Rgb absorption;    // per metre
  int priority;
  Rgb scattering{0, 0, 0};  // per metre
  // The sum of both, per metre: what has not been scattered falls as exp(-extinction distance).
  Rgb extinction{0, 0, 0};
  float anisotropy = 0;  // mean cosine of a scattering (Henyey and Greenstein)
  // Its makers say that light in it is scattered so often that diffusion describes it.
  bool dense = false;
  // Its interface does not refract what it lets through but spreads it (KHR_materials_diffuse_transmission).
  bool diffuse_interface = false;

  bool scatters() const { return max_component(scattering) > 0; }
  /// The scattering coefficient that without anisotropy would diffuse light alike (similarity).
  Rgb reduced_scattering() const { return scattering * (1 - anisotropy); }
  bool operator==(const Medium&) const = default;
};

/// That of a material with has_interior(). KHR_materials_volume: extinction = -ln(color) / distance; a colour
/// of 0 lets nothing through. KHR_materials_volume_scatter: the share of it that is scattering is such that a
/// thick body with isotropic scattering reflects the multi-scatter colour (that extension's formula), and
/// with anisotropy the same (similarity).
Medium make_medium(const Material& material);

/// Index of refraction at a wavelength in nanometres; that of the d line where wavelength is 0. Cauchy's
/// equation with two terms through the Abbe number's lines C, d and F (KHR_materials_dispersion); at least 1
/// where that of the d line is.
float eval_ior(const Medium& medium, float wavelength);

/// The media around a point of a path: those whose surfaces it has entered and not left. Where several are,
/// the one of the highest priority is there, and among equals the one entered last (Schmidt and Budge 2002,
/// Simple Nested Dielectrics in Ray Traced Images). What is nested deeper than kDepth is not seen.
class MediumStack {
 public:
  static constexpr int kDepth = 8;

  bool empty() const { return count_ == 0; }

  /// Crosses the surface of `body` (the placement or solid that a hit names) that bounds `medium`: into it,
  /// or out of it. A body whose parts overlap is left when each of them is. Leaving what was not entered, as
  /// through the back of an open surface, changes nothing.
  void cross(std::uint32_t body, const Medium* medium, bool into);

  /// What is here; null: vacuum, as nearly everywhere.
  const Medium* current() const { return empty() ? nullptr : topmost(); }

 private:
  const Medium* topmost() const;

  struct Entry {
    std::uint32_t body;
    std::int32_t depth;  // how often entered
    const Medium* medium;
  };
  std::array<Entry, kDepth> entries_;  // in the order of entering
  int count_ = 0;
};

}  // namespace parian
