#include "renderer/scene/medium.h"

#include <algorithm>
#include <cmath>

namespace parian {

namespace {

// Nothing is left after 1e-28 m, and, being finite, all is left after 0.
constexpr float kMostAbsorption = 1e30f;

/// The share of attenuation that is scattering in a volume of a multi-scatter colour
/// (KHR_materials_volume_scatter, after Kulla and Conty 2017), by similarity where it is not isotropic.
float scattering_albedo(float color, float anisotropy) {
  if (color == 0) return 0;  // which the formula misses by 6e-6
  const float s =
      4.09712f + 4.20863f * color - std::sqrt(9.59217f + 41.6808f * color + 17.7126f * color * color);
  const float isotropic = std::clamp(1 - s * s, 0.0f, 1.0f);
  return std::min(isotropic / (1 - anisotropy + anisotropy * isotropic), 1.0f);
}

}  // namespace

Medium make_medium(const Material& m) {
  Medium medium{m.ior, m.dispersion, Rgb(0, 0, 0), m.priority};
  medium.diffuse_interface = !m.subsurface && m.diffuse_transmission;
  medium.dense = m.subsurface || m.diffuse_transmission;
  if (m.subsurface) {
    medium.absorption = m.subsurface->absorption;
    medium.scattering = m.subsurface->reduced_scattering;
    medium.extinction = medium.absorption + medium.scattering;
    return medium;
  }
  const Volume& volume = *m.volume;
  if (volume.attenuation_distance <= 0) return medium;
  for (int k = 0; k < 3; ++k) {
    const float extinction = medium.extinction[k] =
        std::min(-std::log(volume.attenuation_color[k]) / volume.attenuation_distance, kMostAbsorption);
    const float albedo =
        m.scatter ? scattering_albedo(m.scatter->multiscatter_color[k], m.scatter->anisotropy) : 0;
    medium.scattering[k] = extinction * albedo;
    medium.absorption[k] = extinction * (1 - albedo);
  }
  if (m.scatter) medium.anisotropy = m.scatter->anisotropy;
  return medium;
}

float eval_ior(const Medium& medium, float wavelength) {
  if (wavelength == 0 || medium.dispersion == 0) return medium.ior;
  // n = A + B / l^2 with n(F) - n(C) = (n(d) - 1) / Abbe; wavelengths in micrometres.
  constexpr float kC = 0.6563f, kD = 0.5876f, kF = 0.4861f;
  const float b = (medium.ior - 1) * (medium.dispersion / 20) / (1 / (kF * kF) - 1 / (kC * kC));
  const float l = wavelength * 1e-3f;
  return std::max(medium.ior + b * (1 / (l * l) - 1 / (kD * kD)), 1.0f);
}

void MediumStack::cross(std::uint32_t body, const Medium* medium, bool into) {
  const auto end = entries_.begin() + count_;
  const auto entry = std::find_if(entries_.begin(), end,
                                  [&](const Entry& e) { return e.body == body && e.medium == medium; });
  if (into) {
    if (entry != end)
      ++entry->depth;
    else if (count_ < kDepth)
      entries_[std::size_t(count_++)] = {body, 1, medium};
  } else if (entry != end && --entry->depth == 0) {
    std::copy(entry + 1, end, entry);
    --count_;
  }
}

const Medium* MediumStack::topmost() const {
  const Medium* best = nullptr;
  for (int i = 0; i < count_; ++i)
    if (!best || entries_[std::size_t(i)].medium->priority >= best->priority)
      best = entries_[std::size_t(i)].medium;
  return best;
}

}  // namespace parian
