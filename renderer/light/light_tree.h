/// A tree over the finite lights of a scene, which chooses one by what it may send to a receiver (Conty
/// Estevez and Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting; Pharr, Jakob and
/// Humphreys 2023, Physically Based Rendering, 12.6.3). From the root down, one of up to eight children is
/// taken in proportion to a bound of the irradiance that its lights can send. Eight are weighed side by side,
/// and the fewer steps there are, the less their bounds mislead.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/math.h"

namespace parian {

/// Whom light is sampled for: a point and the unit normal of the side that receives; zero where both sides
/// do.
struct Receiver {
  Vec3f p, n;
};

/// What the tree knows of a light. It shines within the angle theta_e of some direction in the cone of half
/// angle theta_o around `axis`, and, where it is two-sided, of the opposite ones: a flat light within 90
/// degrees of its normal, a point light everywhere.
struct LightBounds {
  Box3f box;
  Vec3f axis{0, 0, 0};  // unit; any where theta_o is 180 degrees
  float cos_o = 1, cos_e = 0;
  float intensity = 0;      // radiant, along the axis: W/sr, in luminance. 0: never chosen
  float range = kInfinity;  // beyond this, from its box, it reaches nothing
  bool two_sided = false;
};

/// What bounds each child of a node: a sphere around its lights, and which way they shine. Angles are kept as
/// cosines; what rounding does to them is covered by a margin when they are used.
struct LightTreeNode {
  static constexpr int kWidth = 8;
  template <class T>
  using Lanes = std::array<T, kWidth>;

  alignas(32) Lanes<float> center_x{}, center_y{}, center_z{}, radius{};
  Lanes<float> axis_x{}, axis_y{}, axis_z{};
  Lanes<float> cos_o{}, sin_o{}, cos_e{};
  Lanes<float> other_side{};  // -1: two-sided, 1: not
  Lanes<float> intensity{};   // as a part of the node's
  Lanes<float> reach{};       // nothing beyond, from the centre
  // A leaf's light, or an inner child's node.
  static constexpr std::uint32_t kLeaf = 0x80000000u;
  Lanes<std::uint32_t> link{};
  std::uint32_t count = 0;  // of children
};

class LightTree {
 public:
  LightTree() = default;  // empty
  /// Lights are numbered as they come. All numbers but ranges are finite, and intensities are not negative.
  explicit LightTree(std::span<const LightBounds> lights);

  /// No light has any intensity.
  bool empty() const { return nodes_.empty(); }

  /// An estimate of the irradiance (in luminance) that all lights together send to a receiver; 0 only where
  /// none can reach it. The tree must not be empty, here and below.
  double importance(const Receiver& to) const;

  struct Choice {
    int light;
    double probability;  // > 0
    double remainder;    // the rest of u, again uniform in [0, 1)
  };
  /// A light by u in [0, 1), which for thousands of lights needs more bits than a float has. Every light that
  /// can reach the receiver has a probability above 0.
  Choice sample(const Receiver& to, double u) const;
  /// The probability with which sample() chooses the light. Over all lights they add up to 1.
  double probability(const Receiver& to, int light) const;

  std::size_t bytes() const {
    return nodes_.capacity() * sizeof(LightTreeNode) + trails_.capacity() * sizeof(std::uint64_t);
  }
  /// How many nodes the longest way from the root to a light passes.
  int depth() const;

  /// No way passes more nodes.
  static constexpr int kMaxDepth = 21;

 private:
  friend class LightTreeBuilder;
  // The way from the root to a light, kBits for the child of each node, the root's lowest: at most 63 bits.
  static constexpr int kBits = 3;
  static constexpr std::uint64_t kNoTrail = ~std::uint64_t(0);  // of a light that is not in the tree

  std::vector<LightTreeNode> nodes_;   // the root first
  std::vector<std::uint64_t> trails_;  // by light
  double total_ = 0;                   // intensity of all
};

}  // namespace parian
