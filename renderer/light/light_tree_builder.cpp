/// Builds a light tree from the top: a set of lights is cut in two where the heuristic says, and the costlier
/// half again, until a node is full. Lights are moved about in place; subtrees are built in parallel, each
/// into nodes of its own, and laid out one after the other in the end, so that threads change no bit.
#include <algorithm>
#include <bit>
#include <memory>
#include <new>

#include "renderer/base/parallel.h"
#include "renderer/light/light_tree.h"
#include "renderer/light/light_tree_cut.h"

namespace parian {
namespace {

using Item = LightTreeItem;
using Node = LightTreeNode;

// The children of sets larger than this are built in parallel; smaller ones fill a piece each.
constexpr std::size_t kParallel = 4096;
// Lights handed to a thread at a time.
constexpr std::size_t kGrain = 1024;

/// The children of a node of more lights than lanes, which is at that depth.
std::vector<LightTreeRange> cut_into_children(std::span<Item> items, int depth, bool packed) {
  // Halving the largest gives eighths: it needs a node for each three bits of the number of items, and is all
  // that is left where the tree would otherwise become too deep.
  const bool deep = depth + int(std::bit_width(items.size()) + 2) / 3 + 1 >= LightTree::kMaxDepth;
  const LightTreeCut how = deep     ? LightTreeCut::halves
                           : packed ? LightTreeCut::packed
                                    : LightTreeCut::heuristic;
  const std::size_t whole = packed ? Node::kWidth : 1;  // up to this many are not cut any more
  std::vector<LightTreeRange> ranges{{items}};
  while (ranges.size() < Node::kWidth) {
    LightTreeRange* next = nullptr;
    for (LightTreeRange& range : ranges)
      if (range.items.size() > whole &&
          (!next || (deep ? range.items.size() > next->items.size() : range.cost > next->cost)))
        next = &range;
    if (!next) break;
    const auto halves = cut(next->items, how);
    *next = halves[0];
    ranges.push_back(halves[1]);
  }
  return ranges;
}

/// A part of the tree. Of few lights: all their nodes, whose links count from the first. Of many: one node,
/// and the pieces that its lanes stand for.
struct Piece {
  std::vector<Node> nodes;
  std::vector<Piece> below;
  std::uint32_t first = 0;  // where its nodes go in the tree
};

/// Says where the nodes of all pieces go, and lists those that have any. Returns the first free place.
std::uint32_t lay_out(Piece& piece, std::uint32_t first, std::vector<Piece*>& all) {
  piece.first = first;
  all.push_back(&piece);
  first += std::uint32_t(piece.nodes.size());
  for (std::size_t i = 0; i < piece.below.size(); ++i) {
    if (piece.below[i].nodes.empty()) continue;
    piece.nodes[0].link[i] = first;
    first = lay_out(piece.below[i], first, all);
  }
  return first;
}

/// Copies a piece's nodes to their place, with links as they are there, and gives up its memory.
void move_nodes(Piece& piece, std::vector<Node>& to) {
  for (std::size_t k = 0; k < piece.nodes.size(); ++k) {
    Node node = piece.nodes[k];
    for (std::uint32_t i = 0; i < node.count && piece.below.empty(); ++i)
      if (!(node.link[i] & Node::kLeaf)) node.link[i] += piece.first;
    to[piece.first + k] = node;
  }
  piece.nodes = {};
}

/// Items in memory that nobody wrote to before those who fill it, in parallel.
class Items {
 public:
  Items(std::size_t count, const std::function<LightBounds(std::size_t)>& bounds_of)
      : memory_(std::make_unique_for_overwrite<std::byte[]>(count * sizeof(Item))) {
    auto* first = reinterpret_cast<Item*>(memory_.get());
    parallel_for(count, kGrain, [&](std::size_t i) { new (first + i) Item{bounds_of(i), std::uint32_t(i)}; });
    // Only those of some intensity.
    const auto* last =
        std::remove_if(first, first + count, [](const Item& item) { return !(item.bounds.intensity > 0); });
    items_ = {first, std::size_t(last - first)};
  }
  std::span<Item> get() const { return items_; }
  void free() { memory_.reset(), items_ = {}; }

 private:
  static_assert(std::is_trivially_destructible_v<Item>);
  std::unique_ptr<std::byte[]> memory_;
  std::span<Item> items_;
};

// Measured: a packed tree's nodes for each light, and one's that is not. While the items are there, so are
// all nodes; then these are copied.
constexpr double kPackedNodes = 0.168, kNodes = 0.31;

}  // namespace

/// Fills a tree.
class LightTreeBuilder {
 public:
  LightTreeBuilder(LightTree& tree, std::size_t count,
                   const std::function<LightBounds(std::size_t)>& bounds_of)
      : trails_(tree.trails_) {
    Items items(count, bounds_of);
    packed_ = items.get().size() > LightTree::kPacked;
    for (const Item& item : items.get()) tree.total_ += double(item.bounds.intensity);
    if (items.get().empty()) return;
    trails_.assign(count, LightTree::kNoTrail);
    Piece root;
    build(items.get(), 0, 0, root);
    items.free();
    std::vector<Piece*> pieces;
    tree.nodes_.resize(lay_out(root, 0, pieces));
    parallel_for(pieces.size(), 1, [&](std::size_t i) { move_nodes(*pieces[i], tree.nodes_); });
  }

 private:
  using Children = std::array<std::span<Item>, Node::kWidth>;

  static std::uint64_t trail_to(std::size_t child, std::uint64_t trail, int depth) {
    return trail | std::uint64_t(child) << (LightTree::kBits * depth);
  }

  /// Sets up a node of items, to which `trail` leads from the root: its bounds, and links to lights. Returns
  /// its other children by lane; those of one light are empty.
  Children make_node(Node& node, std::span<Item> items, std::uint64_t trail, int depth) {
    Children children;
    std::size_t count = 0;
    if (items.size() <= Node::kWidth) {
      for (; count < items.size(); ++count) children[count] = items.subspan(count, 1);
    } else {
      for (const LightTreeRange& range : cut_into_children(items, depth, packed_))
        children[count++] = range.items;
    }
    set_bounds(node, std::span(children.data(), count));
    for (std::size_t i = 0; i < count; ++i) {
      if (children[i].size() != 1) continue;
      const std::uint32_t light = children[i][0].light;
      node.link[i] = Node::kLeaf | light;
      trails_[light] = trail_to(i, trail, depth);
      children[i] = {};
    }
    return children;
  }

  /// Appends the subtree of the items and returns its root.
  std::uint32_t append(std::span<Item> items, std::uint64_t trail, int depth, std::vector<Node>& nodes) {
    const auto self = std::uint32_t(nodes.size());
    nodes.emplace_back();
    const Children children = make_node(nodes[self], items, trail, depth);
    for (std::size_t i = 0; i < children.size(); ++i) {
      if (children[i].empty()) continue;
      const std::uint32_t child = append(children[i], trail_to(i, trail, depth), depth + 1, nodes);
      nodes[self].link[i] = child;
    }
    return self;
  }

  void build(std::span<Item> items, std::uint64_t trail, int depth, Piece& piece) {
    if (items.size() <= kParallel) {
      piece.nodes.reserve(items.size() / 5 + 2);
      append(items, trail, depth, piece.nodes);
      return;
    }
    piece.nodes.emplace_back();
    const Children children = make_node(piece.nodes[0], items, trail, depth);
    piece.below.resize(Node::kWidth);
    parallel_for(Node::kWidth, 1, [&](std::size_t i) {
      if (!children[i].empty()) build(children[i], trail_to(i, trail, depth), depth + 1, piece.below[i]);
    });
  }

  std::vector<std::uint64_t>& trails_;
  bool packed_ = false;
};

LightTree::LightTree(std::size_t count, const std::function<LightBounds(std::size_t)>& bounds_of) {
  LightTreeBuilder(*this, count, bounds_of);
}

std::size_t LightTree::predicted_bytes(std::size_t lights) {
  const double nodes = lights > kPacked ? kPackedNodes : kNodes;
  return std::size_t(double(lights) * (nodes * sizeof(LightTreeNode) + sizeof(std::uint64_t)));
}

std::size_t LightTree::predicted_peak_bytes(std::size_t lights) {
  const std::size_t tree = predicted_bytes(lights);
  return tree + lights * std::max(sizeof(LightTreeItem), std::size_t(double(tree) / double(lights)));
}

}  // namespace parian
