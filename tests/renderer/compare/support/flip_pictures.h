/// Pictures for FLIP that any program can make again.
#pragma once

#include <cmath>
#include <functional>

#include "renderer/compare/plane.h"

namespace parian {

/// value(x, y, channel) of each pixel.
inline RgbPlanes make_planes(int width, int height, const std::function<double(int, int, int)>& value) {
  RgbPlanes planes{Plane(width, height), Plane(width, height), Plane(width, height)};
  Plane* channels[3] = {&planes.r, &planes.g, &planes.b};
  for (int c = 0; c < 3; ++c)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) channels[c]->row(y)[x] = float(value(x, y, c));
  return planes;
}

/// Waves of another direction for each channel, in [0, 1].
inline double waves(int x, int y, int c) { return 0.5 + 0.5 * std::sin(0.1 * (c + 1) * x + 0.07 * y); }

/// From 2^-6 to 2^6, in waves.
inline double bright_waves(int x, int y, int c) {
  return std::exp2(6 * std::sin(0.05 * x)) * (0.6 + 0.4 * std::sin(0.3 * y + c));
}

/// A pattern that is somewhere between 0 and 1 everywhere and repeats nowhere.
inline double grain(int x, int y, int c) {
  const double value = 43758.5453 * std::sin(12.9898 * x + 78.233 * y + 37.719 * c);
  return value - std::floor(value);
}

}  // namespace parian
