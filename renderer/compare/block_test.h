/// Whether two pictures are estimates of the same one. Pixel by pixel a bias of 10% drowns in the noise;
/// means of blocks see one of 1%.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "renderer/base/image.h"

namespace parian {

/// Whose layer `variance` (of the pixels' means) the differences are measured by. Where it is one picture's
/// alone, the other's is that times the ratio of their samples, by the channel `samples` or the metadata
/// `parian:spp`; where these are unknown, the other counts as exact.
enum class VarianceFrom { test, reference, both };

struct BlockTestOptions {
  double significance = 1e-4;  // that equal means fail any of the tests, by Bonferroni's correction
  // Blocks are at least this many pixels large where the variance is the test's own, alone or in the sum: a
  // pixel whose few samples missed the light that is rarely found is too dark and believes itself exact.
  int smallest_block = 4096;
};

/// The pixels [x0, x1) x [y0, y1) of one channel; z is the difference of the means, test - reference, in
/// standard errors. Not finite where a value or a variance is not, or a variance is negative.
struct BlockScore {
  std::string channel;
  int x0, y0, x1, y1;
  double z;
};

struct BlockTest {
  VarianceFrom variance;
  bool other_is_exact;  // as far as is known: see VarianceFrom
  int blocks_per_side;  // 4; fewer where blocks would be too small; 1: the whole picture alone
  double limit;         // |z| up to which a score is accepted
  std::vector<BlockScore> scores;

  bool accepts(const BlockScore& score) const;
  /// The score of the largest |z|, or one that is NaN.
  const BlockScore& worst() const;
  bool means_agree() const { return accepts(worst()); }
};

/// Compares the means of 4 x 4 blocks and of the whole picture, for each channel C of R, G, B, Y with a
/// channel variance.C, of pictures of equal size, two-sided. The variance is the sum of both where both have
/// one. Nothing where no picture has one. Samples must be independent from pixel to pixel.
std::optional<BlockTest> block_test(const Picture& test, const Picture& reference,
                                    const BlockTestOptions& options = {});

/// z that a standard normal number exceeds, up or down, with probability p in (0, 1).
double two_sided_normal_quantile(double p);

}  // namespace parian
