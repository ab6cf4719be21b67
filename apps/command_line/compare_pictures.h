/// What `parian compare` does with two files.
#pragma once

#include <map>
#include <string>

#include "apps/command_line/compare_report.h"

namespace parian {

struct ComparisonSettings {
  std::string layer;  // empty: all but variance and samples
  float peak = 1;     // of PSNR
  float pixels_per_degree = kPixelsPerDegree;
  double significance = 1e-4;  // of the block test
};

/// A report without what is exceeded, and what a heat map may show: "flip" and "hdr-flip" where the pictures
/// have a colour with the primaries of Rec.709, and "error", the relative errors of the first layer compared.
struct Comparison {
  ComparisonReport report;
  std::map<std::string, Plane> maps;
};

/// Throws InputError where a file cannot be read, or the two cannot be compared; UsageError for a layer that
/// neither has.
Comparison compare_pictures(const std::string& test_file, const std::string& reference_file,
                            const ComparisonSettings& settings);

}  // namespace parian
