/// Light that meets more than one facet of a GGX surface before it leaves, as a lobe beside that of the light
/// that meets one.
#pragma once

#include "materials/albedo.h"

namespace parian {

/// f = Fms (1 - E(wo)) (1 - E(wi)) / (pi (1 - Eavg)), where E is the albedo of facets that reflect all, avg
/// its average over the hemisphere, and Fms what is left of light after two bounces and more (Kulla and Conty
/// 2017, Revisiting Physically Based Shading at Imageworks). Reciprocal; with a reflectance of 1 it returns
/// what the facets lose.
struct FacetBounces {
  GgxAlbedoRow row;
  Rgb strength;  // f over the losses at wo and wi
  float albedo;  // luminance of the lobe's albedo over the loss at wo

  /// The lobe's f, of the losses 1 - E at wo and wi.
  Rgb eval(float loss_o, float loss_i) const { return strength * (loss_o * loss_i); }
};

/// Fms of facets that reflect `average` of the light from all sides, a geometric series over the bounces.
/// `loss` is 1 - Eavg.
inline float bounced_reflectance(float average, float loss) {
  return average * average * (1 - loss) / (1 - average * loss);
}

/// `reflectance`: Fms in each channel.
inline FacetBounces make_facet_bounces(const GgxAlbedoRow& row, const Rgb& reflectance) {
  // A smooth surface loses nothing but where mu is about alpha: bounded so that weights are, which leaves out
  // a part of that for roughness below .08.
  return {row, reflectance * (kInvPi / std::max(row.average_loss, 3e-4f)), luminance(reflectance)};
}

}  // namespace parian
