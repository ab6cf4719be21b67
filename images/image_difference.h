/// Differences of pictures through OpenImageIO: sums over them, and heat maps.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "images/image_io.h"
#include "renderer/base/image.h"

namespace parian {

/// Of test - reference over all pixels of a channel. All are NaN where a pixel's difference is not finite.
struct ChannelDifference {
  std::string channel;
  double mean = 0, mean_absolute = 0, mean_square = 0;
  double lowest = 0, highest = 0;
};

/// For each channel of pictures of equal size and channels.
std::vector<ChannelDifference> channel_differences(const Picture& test, const Picture& reference);

/// The encoding of both files. Throws InputError where they differ: linear against display-referred values,
/// two encodings for the display, other chromaticities.
ColorEncoding shared_color_encoding(const std::string& test_file, const std::string& reference_file);

/// Writes values in [0, 1], row by row, as the colours of the map "magma", black to pale yellow: PNG or JPEG
/// by extension, whole or not at all. What is above 1, or not finite, gets the colour of 1. Throws
/// InputError.
void write_heat_map(std::span<const float> values, int width, int height, const std::string& path);

}  // namespace parian
