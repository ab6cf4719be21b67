/// A tree over the finite lights of a scene, which chooses one by what it may send to a receiver (Conty
/// Estevez and Kulla 2018, Importance Sampling of Many Lights with Adaptive Tree Splitting; Pharr, Jakob and
/// Humphreys 2023, Physically Based Rendering, 12.6.3). From the root down, one of up to eight children is
/// taken in proportion to a bound of the irradiance that its lights can send. Eight are weighed side by side,
/// and the fewer steps there are, the less their bounds mislead.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "renderer/light/light_tree_node.h"

namespace parian {

class LightTree {
 public:
  LightTree() = default;  // empty
  /// Lights are numbered as they come. All numbers but ranges are finite, and intensities are not negative.
  /// bounds_of(i) is called once for each, from several threads. The tree is the same bit for bit for any
  /// number of threads.
  LightTree(std::size_t count, const std::function<LightBounds(std::size_t)>& bounds_of);
  explicit LightTree(std::span<const LightBounds> lights)
      : LightTree(lights.size(), [&](std::size_t i) { return lights[i]; }) {}

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
  /// The probability with which sample() chooses the light, bit for bit. Over all lights they add up to 1.
  double probability(const Receiver& to, int light) const;

  std::size_t bytes() const {
    return nodes_.capacity() * sizeof(LightTreeNode) + trails_.capacity() * sizeof(std::uint64_t);
  }
  /// What bytes() will be for so many lights of some intensity, to 10% where there are more than kPacked, and
  /// the most that building takes on the way, that included.
  static std::size_t predicted_bytes(std::size_t lights);
  static std::size_t predicted_peak_bytes(std::size_t lights);
  /// How many nodes the longest way from the root to a light passes.
  int depth() const;

  /// No way passes more nodes.
  static constexpr int kMaxDepth = 21;
  /// Of more lights than this the nodes are filled up: a third of the memory, fewer steps, and bounds that
  /// are a little wider.
  static constexpr std::size_t kPacked = 4096;

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
