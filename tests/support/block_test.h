/// Whether two pictures are estimates of the same one. Pixel by pixel a bias of 10% drowns in the noise;
/// means of blocks see one of 1%.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "renderer/base/image.h"

namespace parian {

/// Compares R, G and B of pictures of equal size that each have a variance layer (of the pixels' means,
/// independent samples, box filter): the means of 4 x 4 blocks and of the whole picture, two-sided, at 1e-4
/// for all tests together (Bonferroni). Values that are not finite, or differ by more than `largest` alone,
/// fail too: no mean shows a black pixel in ten thousand.
inline testing::AssertionResult blocks_agree(const Picture& a, const Picture& b, double largest = INFINITY) {
  constexpr int kBlocks = 4, kTests = 3 * (kBlocks * kBlocks + 1);
  // Two-sided normal quantile of 1e-4 / 51.
  constexpr double kLimit = 4.7574;
  static_assert(kTests == 51);
  if (a.width != b.width || a.height != b.height) return testing::AssertionFailure() << "other sizes";
  const auto variance_channel = [](const Picture& p) {
    for (std::size_t i = 0; i < p.channels.size(); ++i)
      if (p.channels[i] == "variance.R") return i;
    return p.channels.size();
  };
  const std::size_t va = variance_channel(a), vb = variance_channel(b);
  if (va == a.channels.size() || vb == b.channels.size())
    return testing::AssertionFailure() << "no variance layer";

  const auto compare = [&](int k, int x0, int y0, int x1, int y1) -> double {
    double difference = 0, variance = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        difference += double(a.at(x, y)[k]) - b.at(x, y)[k];
        variance += double(a.at(x, y)[va + std::size_t(k)]) + b.at(x, y)[vb + std::size_t(k)];
      }
    // Pictures without noise must be equal but for rounding.
    return difference / std::sqrt(variance + 1e-12 * (x1 - x0) * (y1 - y0));
  };
  for (int k = 0; k < 3; ++k) {
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x) {
        const double difference = double(a.at(x, y)[k]) - b.at(x, y)[k];
        if (!(std::abs(difference) <= largest))
          return testing::AssertionFailure() << "pixel " << x << ", " << y << " differs by " << difference;
      }
    const double whole = compare(k, 0, 0, a.width, a.height);
    if (!(std::abs(whole) < kLimit))
      return testing::AssertionFailure() << "channel " << k << " is off by " << whole << " standard errors";
    for (int i = 0; i < kBlocks * kBlocks; ++i) {
      const int bx = i % kBlocks, by = i / kBlocks;
      const double z = compare(k, a.width * bx / kBlocks, a.height * by / kBlocks,
                               a.width * (bx + 1) / kBlocks, a.height * (by + 1) / kBlocks);
      if (!(std::abs(z) < kLimit))
        return testing::AssertionFailure() << "channel " << k << " of block " << bx << ", " << by
                                           << " is off by " << z << " standard errors";
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace parian
