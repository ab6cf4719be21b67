/// Whether two pictures are estimates of the same one, for tests of estimators.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/compare/block_test.h"

namespace parian {

/// Compares R, G and B of pictures of equal size that each have a variance layer (of the pixels' means,
/// independent samples, box filter): the means of 4 x 4 blocks and of the whole picture, two-sided, at 1e-4
/// for all tests together (Bonferroni). Values that are not finite, or differ by more than `largest` alone,
/// fail too: no mean shows a black pixel in ten thousand.
inline testing::AssertionResult blocks_agree(const Picture& a, const Picture& b, double largest = INFINITY) {
  if (a.width != b.width || a.height != b.height) return testing::AssertionFailure() << "other sizes";
  // Pictures of equal numbers of samples: what one missed, the other counts, whatever the size of the blocks.
  const auto result = block_test(a, b, {1e-4, 1});
  if (!result || result->variance != VarianceFrom::both)
    return testing::AssertionFailure() << "no variance layer";
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (int k = 0; k < 3; ++k) {
        const double difference = double(a.at(x, y)[k]) - b.at(x, y)[k];
        if (!(std::abs(difference) <= largest))
          return testing::AssertionFailure() << "pixel " << x << ", " << y << " differs by " << difference;
      }
  if (result->means_agree()) return testing::AssertionSuccess();
  const BlockScore& worst = result->worst();
  return testing::AssertionFailure() << worst.channel << " of (" << worst.x0 << ", " << worst.y0 << ") to ("
                                     << worst.x1 << ", " << worst.y1 << ") is off by " << worst.z
                                     << " standard errors";
}

}  // namespace parian
