/// A node of the light tree: what bounds its children, in 32 bytes for each with the node's own share.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include "renderer/light/light_bounds.h"

namespace parian {

/// What the builder moves about: a light's bounds and its number.
struct LightTreeItem {
  LightBounds bounds;
  std::uint32_t light;
};

/// What bounds each child of a node: a sphere around its lights, and which way they shine. Rounded so that no
/// light is outside of what bounds it: centres to a grid of 65536 cells along the longest side of the node,
/// and the radius is from the rounded centre; cosines down, and that of theta_e so far that it covers the
/// rounding of the others; what rounding does to angles beyond that is covered by a margin when they are
/// used.
struct alignas(64) LightTreeNode {
  static constexpr int kWidth = 8;
  template <class T>
  using Lanes = std::array<T, kWidth>;

  // Two numbers of 16 bits in each word, the first below: words of one size become vector code as a whole.
  // Centres in cells; the radius and the reach, beyond which there is nothing, short floats that are rounded
  // up; the intensity, as a part of the node's, a short float; axes and cosines as parts of kOne. With sin_o
  // is kTwoSided.
  Lanes<std::uint32_t> center_xy{}, center_z_radius{};
  Lanes<std::uint32_t> axis_xy{}, axis_z_cos_o{}, sin_o_cos_e{};
  Lanes<std::uint32_t> intensity_reach{};
  // A leaf's light, or an inner child's node.
  static constexpr std::uint32_t kLeaf = 0x80000000u;
  Lanes<std::uint32_t> link{};
  Vec3f origin{0, 0, 0};    // of the grid
  float cell = 0;           // its step
  std::uint32_t count = 0;  // of children

  static constexpr float kOne = 32767;
  static constexpr std::uint32_t kTwoSided = 0x8000u;
};
static_assert(sizeof(LightTreeNode) == 256);

/// What is in a word: unsigned and signed numbers, and short floats, which are positive ones without their
/// sign and the last 15 bits: 8 bits of mantissa, the full range.
inline float low_number(std::uint32_t word) { return float(std::int32_t(word & 0xffffu)); }
inline float high_number(std::uint32_t word) { return float(std::int32_t(word >> 16)); }
inline float low_signed(std::uint32_t word) { return float(std::int32_t(word << 16) >> 16); }
inline float high_signed(std::uint32_t word) { return float(std::int32_t(word) >> 16); }
inline float low_short_float(std::uint32_t word) { return std::bit_cast<float>((word & 0xffffu) << 15); }
inline float high_short_float(std::uint32_t word) { return std::bit_cast<float>((word >> 16) << 15); }

/// Sets what bounds the lights of each of a node's children, of which there are 1 to kWidth; all but links.
/// Children of many lights are done in parallel.
void set_bounds(LightTreeNode& node, std::span<const std::span<LightTreeItem>> children);

}  // namespace parian
