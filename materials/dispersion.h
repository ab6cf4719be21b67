/// Colour and wavelength: what turns a path of three colours into one of a single wavelength.
#pragma once

#include "renderer/base/math.h"
#include "renderer/base/sampling.h"

namespace parian {

struct WavelengthSample {
  float wavelength;  // nanometres
  Rgb weight;        // what the wavelength is of each channel, over its density; its mean is white
};

/// A wavelength, sampled as the channels together respond to it. Each channel's response is a bell around the
/// peak of the positive part of its Rec.709 colour matching function: of mean 1 by construction, never
/// negative, and so that neighbours overlap, which makes a continuous spectrum of three numbers. (Exact
/// matching functions are negative where colours are out of gamut.) u1 chooses the channel.
inline WavelengthSample sample_wavelength(float u1, const Vec2f& u2) {
  constexpr float kPeak[3] = {605, 542, 452}, kWidth[3] = {30, 32, 22};
  const int channel = std::min(int(3 * u1), 2);
  // Normally distributed (Box and Muller 1958), cut off where its density is 1e-6 of the peak's.
  const float r = std::sqrt(-2 * std::log(std::max(1 - u2.x, 1e-6f)));
  const float wavelength = kPeak[channel] + kWidth[channel] * r * unit_circle(u2.y).x;
  Rgb density;
  for (int k = 0; k < 3; ++k) {
    const float x = (wavelength - kPeak[k]) / kWidth[k];
    density[k] = std::exp(-0.5f * x * x) / kWidth[k];
  }
  return {wavelength, density * (3 / (density.x + density.y + density.z))};
}

}  // namespace parian
