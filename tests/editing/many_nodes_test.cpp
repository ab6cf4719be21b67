// Commands on many nodes at once, against the same done one by one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "editing/add.h"
#include "editing/nodes.h"
#include "editing/tree.h"
#include "renderer/scene/node_bounds.h"

namespace parian {
namespace {

using edit::find_parents;

/// Nodes of any depth, some of them hidden or showing a ball, and some of them chosen, more than once too.
struct RandomTree {
  explicit RandomTree(unsigned seed) : random(seed) {
    for (int i = 0; i < 40; ++i) {
      const int parent = below(3) ? below(i + 1) - 1 : kNone;
      edit::Place at{.parent = parent, .transform = {}};
      at.transform.translation = {float(below(9)), float(below(9)), 0};
      const std::string name = fmt::format("node {}", i);
      const int node =
          below(2) ? edit::add_shape(scene, edit::sphere(0.5f), at) : edit::add_group(scene, name, at);
      edit::rename_node(scene, node, name);
      edit::set_visible(scene, node, below(9) != 0);
    }
    for (int i = below(12); i >= 0; --i) chosen.push_back(below(40));
  }
  int below(int most) { return std::uniform_int_distribution(0, most - 1)(random); }
  bool is_above(int a, int b) const {
    const std::vector<int> parents = find_parents(scene);
    for (b = parents[std::size_t(b)]; b != kNone && b != a; b = parents[std::size_t(b)]) {
    }
    return b == a;
  }

  std::mt19937 random;
  Scene scene;
  std::vector<int> chosen;
};

TEST(ManyNodes, TopmostAreBelowNoneOfTheOthers) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const RandomTree tree(seed);
    std::vector<int> expected;
    for (const int node : tree.chosen)
      if (std::ranges::find(expected, node) == expected.end() &&
          std::ranges::none_of(tree.chosen, [&](int other) { return tree.is_above(other, node); }))
        expected.push_back(node);
    EXPECT_EQ(edit::find_topmost(tree.scene, tree.chosen), expected);
  }
}

TEST(ManyNodes, AreRemovedAsOneByOne) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const RandomTree tree(seed);
    Scene at_once = tree.scene, one_by_one = tree.scene;
    const std::vector<int> places = edit::remove(at_once, tree.chosen);
    std::vector<int> left = tree.chosen, now(tree.scene.nodes.size());
    std::iota(now.begin(), now.end(), 0);
    const auto follow = [](std::vector<int>& nodes, const std::vector<int>& moved) {
      for (int& node : nodes)
        if (node != kNone) node = moved[std::size_t(node)];
    };
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (left[i] == kNone) continue;
      const std::vector<int> moved = edit::remove(one_by_one, left[i]);
      follow(left, moved);
      follow(now, moved);
    }
    EXPECT_EQ(at_once, one_by_one);
    EXPECT_EQ(places, now);
  }
}

// What is below another of them is copied with that alone; the copies follow the last of their siblings.
TEST(ManyNodes, AreDuplicatedOnce) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    const RandomTree tree(seed);
    const Scene& before = tree.scene;
    Scene after = before;
    const std::vector<int> originals = edit::find_topmost(before, tree.chosen);
    const std::vector<int> copies = edit::duplicate(after, tree.chosen);
    ASSERT_EQ(copies.size(), originals.size());
    std::size_t count = before.nodes.size();
    const std::vector<int> parents = find_parents(after);
    for (std::size_t i = 0; i < copies.size(); ++i) {
      const std::vector<int> old_nodes = edit::find_subtree(before, originals[i]),
                             new_nodes = edit::find_subtree(after, copies[i]);
      count += old_nodes.size();
      ASSERT_EQ(new_nodes.size(), old_nodes.size());
      for (std::size_t k = 0; k < new_nodes.size(); ++k) {
        Node a = before.nodes[std::size_t(old_nodes[k])], b = after.nodes[std::size_t(new_nodes[k])];
        EXPECT_GE(new_nodes[k], int(before.nodes.size()));
        EXPECT_EQ(a.children.size(), b.children.size());
        a.children = b.children;
        EXPECT_EQ(a, b);
      }
      EXPECT_EQ(parents[std::size_t(copies[i])], parents[std::size_t(originals[i])]);
    }
    EXPECT_EQ(after.nodes.size(), count);
    // Without the copies all is as before, and they stand side by side.
    for (int parent = -1; parent < int(before.nodes.size()); ++parent) {
      std::vector<int> list = edit::children_of(std::as_const(after), parent);
      const auto is_new = [&](int node) { return node >= int(before.nodes.size()); };
      const auto first = std::ranges::find_if(list, is_new);
      const auto last = std::find_if_not(first, list.end(), is_new);
      EXPECT_TRUE(std::none_of(last, list.end(), is_new));
      if (first != list.end()) {
        ASSERT_NE(first, list.begin());
        EXPECT_NE(std::ranges::find(originals, *std::prev(first)), originals.end());
      }
      std::erase_if(list, is_new);
      EXPECT_EQ(list, edit::children_of(before, parent));
    }
  }
}

TEST(ManyNodes, HaveTheBoundsOfEachAndAllBelow) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomTree tree(seed);
    const World world = make_world(tree.scene);
    tree.chosen.push_back(40);  // is not there
    tree.chosen.push_back(kNone);
    const std::vector<Box3f> boxes = subtree_bounds(tree.scene, world, tree.chosen);
    ASSERT_EQ(boxes.size(), tree.chosen.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      Box3f expected;
      for (const PlacedSolid& solid : world.solids)
        if (const int node = int(solid.node); node == tree.chosen[i] || tree.is_above(tree.chosen[i], node)) {
          const Vec3f centre = solid.to_world.origin;
          expected.extendBy(centre - Vec3f(0.5f));
          expected.extendBy(centre + Vec3f(0.5f));
        }
      if (tree.chosen[i] == kNone) expected = Box3f();
      EXPECT_EQ(boxes[i].isEmpty(), expected.isEmpty());
      if (expected.isEmpty()) continue;
      EXPECT_LT((boxes[i].min - expected.min).length() + (boxes[i].max - expected.max).length(), 1e-4f);
    }
  }
}

}  // namespace
}  // namespace parian
