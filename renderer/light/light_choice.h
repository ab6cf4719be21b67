/// Which light is sampled: by chance alone, by power, or by what it may send to the receiver.
#pragma once

#include <span>
#include <vector>

#include "renderer/base/distribution.h"
#include "renderer/light/light_tree.h"

namespace parian {

enum class LightChoice : std::uint8_t {
  uniform,  // every light that shines alike
  power,    // in proportion to its power, wherever the receiver is
  tree,     // by a LightTree, but for scenes of very few lights
};

/// A light that has no place: its irradiance (in luminance) is the same everywhere on a surface across it.
struct InfiniteLight {
  int light;
  float irradiance;
  Vec3f towards;  // unit; zero where light comes from all sides, on every surface alike
};

/// Chooses lights, which are numbered: by fixed weights, or by a tree.
class LightChooser {
 public:
  LightChooser() = default;
  /// In proportion to the weights, wherever the receiver is.
  explicit LightChooser(std::span<const float> weights) : distribution_(weights) {}
  /// By what lights may send to the receiver. All have bounds, which bounds_of(i) gives as LightTree asks;
  /// those in `infinite` are of no intensity.
  LightChooser(std::size_t count, const std::function<LightBounds(std::size_t)>& bounds_of,
               std::vector<InfiniteLight> infinite);

  struct Choice {
    int light;
    float probability;  // 0: no light was found
    float remainder;    // the rest of u, again uniform in [0, 1)
  };
  /// A light for a receiver, by u in [0, 1).
  Choice choose(const Receiver& to, double u) const {
    if (by_place_) return choose_by_place(to, u);
    // A double below 1 may round to 1.
    const Distribution1D::Sample chosen = distribution_.sample(std::min(float(u), 0x1.fffffep-1f));
    return {chosen.index, chosen.probability, chosen.remainder};
  }
  /// The probability with which choose() chooses the light for the receiver.
  float probability(const Receiver& to, int light) const {
    return by_place_ ? probability_by_place(to, light) : distribution_.probability(light);
  }

  /// Whether it depends on the receiver.
  bool is_by_place() const { return by_place_; }
  const LightTree& tree() const { return tree_; }
  std::size_t bytes() const {
    return distribution_.bytes() + tree_.bytes() + infinite_.capacity() * sizeof(InfiniteLight);
  }

 private:
  Choice choose_by_place(const Receiver& to, double u) const;
  float probability_by_place(const Receiver& to, int light) const;
  double infinite_importance(const Receiver& to) const;
  double infinite_share(const Receiver& to, double infinite) const;

  bool by_place_ = false;                // by the tree
  Distribution1D distribution_;          // where it is not by place
  LightTree tree_;                       // of the finite lights
  std::vector<InfiniteLight> infinite_;  // of some irradiance, by their numbers
};

}  // namespace parian
