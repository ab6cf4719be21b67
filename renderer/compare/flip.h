/// FLIP: how much a viewer sees of the difference of two pictures that take each other's place on the screen.
/// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild 2020, "FLIP: A Difference Evaluator
/// for Alternating Images"; for high dynamic range, Andersson, Nilsson, Shirley and Akenine-Moller 2021,
/// "Visualizing Errors in Rendered High Dynamic Range Images".
#pragma once

#include "renderer/compare/plane.h"

namespace parian {

/// 0.7 m before a screen 0.7 m and 3840 pixels wide, the papers' choice.
inline constexpr float kPixelsPerDegree = 0.7f * 3840 / 0.7f * 3.14159265f / 180;

/// From 0 (no difference is seen) to 1, for each pixel, of pictures of equal size in [0, 1]; what lies
/// outside is clamped. All values must be finite. The result is the same when the pictures change places.
Plane ldr_flip(const RgbPlanes& test, const RgbPlanes& reference, float pixels_per_degree = kPixelsPerDegree);

/// Exposures in stops: `count` >= 2 in equal steps from `start` to `stop`.
struct ExposureRange {
  float start = 0, stop = 0;
  int count = 2;
};

/// The exposures that a viewer of this picture may choose: from the one that shows its largest luminance at
/// 85% of the screen's white to the one that shows its median there (2021, section 4), at most a stop apart.
/// Of a picture whose median is black, the median of what is not; of a black one, exposure 0.
ExposureRange exposure_range(const RgbPlanes& reference);

/// The largest of the pixel's ldr_flip() over the exposures, through the ACES curve (Narkowicz 2015). The
/// values may be any that are finite.
Plane hdr_flip(const RgbPlanes& test, const RgbPlanes& reference, const ExposureRange& exposures,
               float pixels_per_degree = kPixelsPerDegree);

}  // namespace parian
