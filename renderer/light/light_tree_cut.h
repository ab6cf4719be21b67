/// How the builder of the light tree cuts a set of lights in two.
#pragma once

#include <span>

#include "renderer/light/light_tree_node.h"

namespace parian {

/// Lights that a child will hold, and what that costs by the heuristic.
struct LightTreeRange {
  std::span<LightTreeItem> items;
  double cost = 0;
};

enum class LightTreeCut : std::uint8_t {
  heuristic,  // where the costs of both halves add up to the least
  packed,     // near there: so that a half of few lights is a multiple of a node's width
  halves,     // in the middle: what is left where a tree would become too deep
};

/// Cuts a range of two or more into two, and puts its items in order.
std::array<LightTreeRange, 2> cut(std::span<LightTreeItem> items, LightTreeCut how);

}  // namespace parian
