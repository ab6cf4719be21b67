/// The filters of FLIP.
#pragma once

#include "renderer/compare/plane.h"

namespace parian {

/// What the eye resolves of each opponent channel (Andersson et al. 2020, section 4.1; after Johnson and
/// Fairchild 2003). A kernel is applied along rows and columns. Blue-yellow is the sum of two Gaussians,
/// which are separable only one by one: their results are added by their weights.
struct ContrastKernels {
  Kernel luminance, red_green, blue_yellow[2];
  float blue_yellow_weight[2];
};

ContrastKernels contrast_kernels(float pixels_per_degree);

/// A Gaussian and its first and second derivatives, by which edges and points are found (section 4.3). The
/// positive weights of each add up to 1, and the negative ones of the derivatives to -1.
struct FeatureKernels {
  Kernel gaussian, edge, point;
};

FeatureKernels feature_kernels(float pixels_per_degree);

}  // namespace parian
