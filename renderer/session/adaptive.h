/// Adaptive sampling: where the samples of the next pass go.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/film/noise.h"

namespace parian {

/// Samples that every pixel gets before any place is judged.
inline constexpr std::uint32_t kMinAdaptiveSamples = 16;

/// Samples that the pixels of each block are to have after the next pass, no fewer than they have; empty if
/// the bound of the noise is within `target`, or `max_samples` are spent on the mean pixel.
///
/// The error of a picture is least for its time where a place has samples in proportion to the standard
/// deviation there, over the root of what a sample costs (Neyman 1934); in proportion to the variance, as
/// they come out where each pixel goes on until its own error is small enough, they bring no more than the
/// same number for all. What the pixels of a block say of their deviation is noise itself, and goes with
/// their means, so that to trust it alone would be a bias: the deviation is averaged over 3 x 3 blocks, and
/// no block has less than an eighth of the mean.
std::vector<std::uint32_t> plan_adaptive_pass(const BlockNoise& blocks, double target,
                                              std::uint32_t max_samples);

}  // namespace parian
