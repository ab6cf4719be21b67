#include "renderer/light/light_tree.h"

#include <algorithm>

#include "renderer/base/vectorize.h"

namespace parian {
namespace {

using Node = LightTreeNode;
using Weights = Node::Lanes<float>;
constexpr int kWidth = Node::kWidth;

// Radians by which all lights seem larger, so that no rounding hides one that can be reached: a cosine in
// single precision gives an angle near 0 to sqrt(2^-23) = 3.5e-4 only, and two such angles are compared.
constexpr float kAngleMargin = 1e-3f;
// What can be reached weighs at least this much, whatever underflows.
constexpr float kLeastWeight = 1e-37f;
constexpr double kBelowOne = 0x1.fffffffffffffp-1;
constexpr float kStep = 1 / Node::kOne;

float complement(float cosine) { return std::sqrt(std::max(0.0f, (1 - cosine) * (1 + cosine))); }

/// The cosine of the angle a minus the angle b, or of 0 where b is larger.
float cosine_of_difference(float cos_a, float cos_b, float sin_b) {
  const float cosine = cos_a * cos_b + complement(cos_a) * sin_b;
  return cos_a >= cos_b ? 1 : cosine;
}

/// The weight of each child: a bound of the irradiance that it sends, but for the factor of the node's
/// intensity. Intensity times the largest cosine at the lights times the largest at the receiver over the
/// square of the distance to the centre, which counts as the radius at least. 0 only where no light can reach
/// it. Without branches, or it would not become vector code.
PARIAN_VECTORIZE void weigh_children(const Node& node, const Receiver& to, Weights& weights) {
  const Vec3f p = node.origin - to.p, n = to.n;  // or they might change with the weights
  const float cell = node.cell, both_sides = n == Vec3f(0) ? 1.0f : 0.0f;
  for (int i = 0; i < kWidth; ++i) {
    const float x = p.x + low_number(node.center_xy[i]) * cell,
                y = p.y + high_number(node.center_xy[i]) * cell,
                z = p.z + low_number(node.center_z_radius[i]) * cell;
    const float radius = high_short_float(node.center_z_radius[i]);
    const float d2 = std::max(x * x + y * y + z * z, 1e-30f), d = std::sqrt(d2), scale = 1 / d;
    // The angle that the sphere fills; from inside of it lights may be in any direction.
    const float sine = radius * scale + kAngleMargin;
    const float cos_size = sine >= 1 ? -1 : complement(sine), sin_size = sine >= 1 ? 0 : sine;

    // Between the axis and the receiver, less that of the cone and the size; where these add up to more than
    // 180 degrees, their sine is negative.
    const float along = low_signed(node.axis_xy[i]) * x + high_signed(node.axis_xy[i]) * y +
                        low_signed(node.axis_z_cos_o[i]) * z;
    const std::uint32_t sine_and_side = node.sin_o_cos_e[i];
    const float front = -scale * kStep * along;
    const float cos_axis = std::max(front, sine_and_side & Node::kTwoSided ? -front : front);
    const float cos_o = high_signed(node.axis_z_cos_o[i]) * kStep,
                sin_o = low_number(sine_and_side & ~Node::kTwoSided) * kStep;
    const float sin_sum = sin_o * cos_size + cos_o * sin_size;
    const float cos_sum = sin_sum < 0 ? -1 : cos_o * cos_size - sin_o * sin_size;
    const float at_light = cosine_of_difference(cos_axis, cos_sum, sin_sum);

    const float facing = scale * (n.x * x + n.y * y + n.z * z);
    const float at_receiver = std::max(cosine_of_difference(facing, cos_size, sin_size), both_sides);

    const float spread = low_short_float(node.intensity_reach[i]) / std::max(d2, radius * radius);
    const float weight = std::max(spread * at_light * at_receiver, kLeastWeight);
    const bool reached = (at_light > high_signed(sine_and_side) * kStep) & (at_receiver > 0) &
                         (d <= high_short_float(node.intensity_reach[i]));
    weights[i] = reached ? weight : 0.0f;
  }
}

/// Weighs the children and returns the sums of the weights up to each, of both halves side by side. Where no
/// light reaches the receiver, which the bounds of the parent did not show, children weigh alike.
Node::Lanes<double> add_weights(const Node& node, const Receiver& to, Weights& weights) {
  constexpr int kHalf = kWidth / 2;
  weigh_children(node, to, weights);
  Node::Lanes<double> sums;
  double low = 0, high = 0;
  for (int i = 0; i < kHalf; ++i) {
    sums[i] = low += double(weights[i]);
    sums[kHalf + i] = high += double(weights[kHalf + i]);
  }
  for (int i = kHalf; i < kWidth; ++i) sums[i] += low;
  if (!(sums[kWidth - 1] > 0))
    for (int i = 0; i < kWidth; ++i) {
      weights[i] = std::uint32_t(i) < node.count ? 1.0f : 0.0f;
      sums[i] = std::min<double>(i + 1, node.count);
    }
  return sums;
}

}  // namespace

double LightTree::importance(const Receiver& to) const {
  alignas(32) Weights weights;
  weigh_children(nodes_[0], to, weights);
  double sum = 0;
  for (const float weight : weights) sum += double(weight);
  return total_ * sum;
}

LightTree::Choice LightTree::sample(const Receiver& to, double u) const {
  alignas(32) Weights weights;
  double probability = 1;
  for (std::uint32_t link = 0;;) {
    const Node& node = nodes_[link];
    const Node::Lanes<double> sums = add_weights(node, to, weights);
    // As u < 1 this rounds to less than the last sum.
    const double at = u * sums[kWidth - 1];
    int child = 0;
    for (const double sum : sums) child += sum <= at;
    const double weight = weights[child], before = child == 0 ? 0 : sums[child - 1];
    probability *= weight / sums[kWidth - 1];
    u = std::clamp((at - before) / weight, 0.0, kBelowOne);
    link = node.link[child];
    if (link & Node::kLeaf) return {int(link & ~Node::kLeaf), probability, u};
  }
}

double LightTree::probability(const Receiver& to, int light) const {
  std::uint64_t trail = trails_[std::size_t(light)];
  if (trail == kNoTrail) return 0;
  alignas(32) Weights weights;
  double probability = 1;
  for (std::uint32_t link = 0; !(link & Node::kLeaf); trail >>= kBits) {
    const Node& node = nodes_[link];
    const Node::Lanes<double> sums = add_weights(node, to, weights);
    const int child = int(trail & (kWidth - 1));
    probability *= double(weights[child]) / sums[kWidth - 1];
    link = node.link[child];
  }
  return probability;
}

int LightTree::depth() const {
  // Children come after their parents.
  std::vector<int> depths(nodes_.size(), 1);
  int deepest = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    deepest = std::max(deepest, depths[k]);
    for (std::uint32_t i = 0; i < nodes_[k].count; ++i)
      if (const std::uint32_t link = nodes_[k].link[i]; !(link & Node::kLeaf)) depths[link] = depths[k] + 1;
  }
  return deepest;
}

}  // namespace parian
