/// How noisy a picture is, estimated from its own samples.
#pragma once

#include <cstdint>
#include <vector>

namespace parian {

/// The noise of each block of kBlock x kBlock pixels, row by row.
struct BlockNoise {
  int columns = 0, rows = 0;
  // Variance of the pixels' means, averaged over pixels and channels, over the square of what is there: the
  // mean of the block's channels and pixels, and kNoiseFloor of the picture's beside it. Blocks where a pixel
  // has one sample alone have infinity.
  std::vector<double> error;
  // The same over the least that the block's mean may be (95%, one-sided): one bright sample makes a mean as
  // large as its error, and the error would look small beside it.
  std::vector<double> most_error;
  std::vector<std::uint32_t> samples;  // of each pixel of the block
  std::vector<double> weight;          // share of the picture's pixels
  std::vector<double> cost;            // rays of a sample
};

/// What the noise of dark places is relative to, beside their own mean: this part of the picture's mean.
/// Without it, nearly black corners would get most of the samples.
inline constexpr double kNoiseFloor = .25;

/// Of the normal distribution, for bounds of 95%.
inline constexpr double kNoiseQuantile = 1.645;

/// Root mean square over the picture of the relative error.
struct Noise {
  double estimate;
  // With a confidence of 95% (one-sided, normal) not exceeded. The spread of the blocks stands for what is
  // not known of their errors: it is at least that, since blocks do differ. What no sample has met yet (light
  // that comes by one path in a million) no estimate can know of.
  double bound;
};
Noise picture_noise(const BlockNoise& blocks);

}  // namespace parian
