/// What `parian compare` found, as text and as JSON.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "images/image_difference.h"
#include "renderer/compare/block_test.h"
#include "renderer/compare/flip.h"
#include "renderer/compare/pixel_errors.h"

namespace parian {

/// How many pixels have a channel that is NaN or Inf.
struct NotFinite {
  std::size_t pixels = 0, test = 0, reference = 0;
};

/// Numbers of one layer; NaN where a pixel is not finite.
struct LayerReport {
  std::string name;
  NotFinite not_finite;
  double rmse = 0, relative_mse = 0;
  std::optional<double> psnr;  // of the colour alone
  LargestDifference largest;
  std::vector<ChannelDifference> channels;

  /// The largest |mean| of a channel; NaN where one is.
  double mean_difference() const;
};

/// Means over the picture; NaN where a pixel is not finite.
struct FlipReport {
  double ldr = 0;
  std::optional<double> hdr;  // of linear pictures
  ExposureRange exposures;
  float pixels_per_degree = 0;
};

/// A number that is not within what an option allows; NaN where a pixel of any layer is not finite.
struct Exceeded {
  std::string number, layer;  // no layer where the number is of the picture
  double value = 0, limit = 0;
};

struct ComparisonReport {
  std::string test, reference;
  int width = 0, height = 0;
  std::vector<LayerReport> layers;
  std::optional<FlipReport> flip;
  std::optional<BlockTest> blocks;
  std::vector<Exceeded> exceeded;
};

/// For a person, in lines.
std::string to_text(const ComparisonReport& report);

/// All of it; a number that is not finite is null.
std::string to_json(const ComparisonReport& report);

}  // namespace parian
