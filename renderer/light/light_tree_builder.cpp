/// Builds a light tree from the top: a set of lights is cut in two where the surface area orientation
/// heuristic says (Conty Estevez and Kulla 2018, 4.2), and the costlier half again, until a node is full.
#include <algorithm>
#include <array>
#include <bit>

#include "renderer/base/parallel.h"
#include "renderer/light/light_tree.h"

namespace parian {
namespace {

constexpr int kBuckets = 12;
// Sets larger than this have their halves built in parallel.
constexpr std::size_t kParallel = 4096;
// No child has less than this part of a node's intensity: below, numbers would underflow.
constexpr double kLeastIntensity = 1e-30;
// The cosine of no theta_e is larger: in single precision a light is found within a cone of some width.
constexpr float kLargestCosE = 0.9999995f;

struct Item {
  LightBounds bounds;
  Vec3f center;
  std::uint32_t light;
};

double angle(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

/// The axis of a light, turned to the side of `axis` where it shines to both.
Vec3f aligned(const LightBounds& light, const Vec3f& axis) {
  return light.two_sided && light.axis.dot(axis) < 0 ? -light.axis : light.axis;
}

/// The measure of directions in which lights of a cone shine, each weighted by its cosine (Conty Estevez and
/// Kulla 2018, equation 1).
double orientation_measure(double cos_o, double cos_e) {
  const double pi = std::numbers::pi, theta_o = angle(cos_o), theta_w = std::min(theta_o + angle(cos_e), pi);
  return 2 * pi * (1 - cos_o) + pi / 2 *
                                    (2 * theta_w * std::sin(theta_o) - std::cos(theta_o - 2 * theta_w) -
                                     2 * theta_o * std::sin(theta_o) + cos_o);
}

/// What the heuristic needs of a set of lights; sets add up.
struct LightSet {
  Box3f box;
  double intensity = 0;
  Vec3f axes{0, 0, 0};  // sum of the mean directions of their cones
  float cos_e = 1;
  std::size_t count = 0;

  void add(const Item& item, const Vec3f& axis) {
    box.extendBy(item.bounds.box);
    intensity += item.bounds.intensity;
    axes += aligned(item.bounds, axis) * (0.5f * (1 + item.bounds.cos_o));
    cos_e = std::min(cos_e, item.bounds.cos_e);
    ++count;
  }
  void add(const LightSet& other) {
    box.extendBy(other.box);
    intensity += other.intensity;
    axes += other.axes;
    cos_e = std::min(cos_e, other.cos_e);
    count += other.count;
  }
  /// The heuristic's cost. Instead of the area of the box, that of the sphere around it, which is what a node
  /// keeps and is not 0 for lights on a line. Instead of a cone around all axes, which needs one more pass
  /// for each way to cut, the cone whose directions have a mean of the same length: (1 + cos theta_o) / 2.
  double cost() const {
    const Vec3f size = box.size();
    const double spread = double(axes.length()) / double(count);
    return intensity * double(size.dot(size)) * orientation_measure(2 * std::min(spread, 1.0) - 1, cos_e);
  }
};

/// Two sets out of one: the items whose centres are in lower buckets along the axis, and the others.
struct Cut {
  int axis = -1;   // none was found
  int bucket = 0;  // the first of the second set
};

/// The bucket of a centre along an axis of the box of all centres, which is not flat there.
int bucket_of(const Vec3f& center, const Box3f& centers, int axis) {
  const float at = (center[axis] - centers.min[axis]) / (centers.max[axis] - centers.min[axis]);
  return std::clamp(int(at * kBuckets), 0, kBuckets - 1);
}

Cut best_cut(std::span<const Item> items, const Box3f& centers, const Vec3f& axis) {
  Cut best;
  double least = std::numeric_limits<double>::infinity();
  const Vec3f size = centers.size();
  for (int k = 0; k < 3; ++k) {
    if (!(size[k] > 0)) continue;
    std::array<LightSet, kBuckets> buckets;
    for (const Item& item : items) buckets[std::size_t(bucket_of(item.center, centers, k))].add(item, axis);
    std::array<double, kBuckets> cost{};  // of the buckets from each on
    LightSet after, before;
    for (int i = kBuckets - 1; i > 0; --i) {
      if (buckets[i].count > 0) after.add(buckets[i]);
      cost[i] = after.count > 0 ? after.cost() : 0;
    }
    for (int i = 1; i < kBuckets; ++i) {
      if (buckets[i - 1].count > 0) before.add(buckets[i - 1]);
      if (before.count == 0 || before.count == items.size()) continue;
      // Thin halves are discouraged.
      const double both = (before.cost() + cost[i]) * double(max_component(size) / size[k]);
      if (both < least) {
        least = both;
        best = {k, i};
      }
    }
  }
  return best;
}

/// Lights that a child will hold.
struct Range {
  std::span<Item> items;
  double cost;  // by the heuristic; the highest is cut next

  explicit Range(std::span<Item> of) : items(of), cost(0) {
    LightSet set;
    for (const Item& item : items) set.add(item, items[0].bounds.axis);
    cost = set.cost();
  }
};

/// Orders the items and returns how many go into the first half.
std::size_t cut(std::span<Item> items, bool by_heuristic) {
  const std::size_t middle = items.size() / 2;
  if (items.size() == 2) return middle;
  Box3f centers;
  for (const Item& item : items) centers.extendBy(item.center);
  if (by_heuristic) {
    if (const Cut best = best_cut(items, centers, items[0].bounds.axis); best.axis >= 0) {
      const auto second = std::partition(items.begin(), items.end(), [&](const Item& item) {
        return bucket_of(item.center, centers, best.axis) < best.bucket;
      });
      return std::size_t(second - items.begin());
    }
  }
  const Vec3f size = centers.size();
  const int widest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(middle), items.end(),
                   [&](const Item& a, const Item& b) { return a.center[widest] < b.center[widest]; });
  return middle;
}

/// Cuts the items into the children of a node, which is at that depth.
std::vector<Range> cut_into_children(std::span<Item> items, int depth) {
  // Halving the largest gives eighths: it needs a node for each three bits of the number of items, and is all
  // that is left where the tree would otherwise become too deep.
  const bool deep = depth + int(std::bit_width(items.size()) + 2) / 3 + 1 >= LightTree::kMaxDepth;
  std::vector<Range> ranges{Range(items)};
  while (ranges.size() < LightTreeNode::kWidth) {
    Range* next = nullptr;
    for (Range& range : ranges)
      if (range.items.size() > 1 &&
          (!next || (deep ? range.items.size() > next->items.size() : range.cost > next->cost)))
        next = &range;
    if (!next) break;
    const std::span<Item> both = next->items;
    const std::size_t half = cut(both, !deep);
    *next = Range(both.first(half));
    ranges.emplace_back(both.subspan(half));
  }
  return ranges;
}

/// Writes what bounds the items to lane i; all but the link.
void set_bounds(LightTreeNode& node, int i, std::span<const Item> items, double node_intensity) {
  Box3f box;
  double intensity = 0;
  Vec3d axes(0, 0, 0);
  bool two_sided = false;
  node.cos_e[i] = kLargestCosE;
  for (const Item& item : items) {
    box.extendBy(item.bounds.box);
    intensity += item.bounds.intensity;
    axes += Vec3d(aligned(item.bounds, Vec3f(axes)));
    node.cos_e[i] = std::min(node.cos_e[i], item.bounds.cos_e);
    two_sided |= item.bounds.two_sided;
  }
  const Vec3f center = box.center(), axis(axes.normalized());
  float radius = 0, reach = 0;
  double theta_o = 0;
  for (const Item& item : items) {
    const LightBounds& light = item.bounds;
    const float furthest = max(abs(light.box.min - center), abs(light.box.max - center)).length();
    radius = std::max(radius, furthest);
    reach = std::max(reach, furthest + light.range);
    double cosine = Vec3d(axis).dot(Vec3d(light.axis));
    if (light.two_sided) cosine = std::abs(cosine);
    theta_o = std::max(theta_o, angle(cosine) + angle(light.cos_o));
  }
  // Points of a light are rounded: 16 times, as plane_offset() has it, from the largest coordinate.
  const float rounding = error_gamma(16) * max_component(max(abs(box.min), abs(box.max)));
  theta_o = std::min(theta_o, std::numbers::pi);
  node.center_x[i] = center.x;
  node.center_y[i] = center.y;
  node.center_z[i] = center.z;
  node.radius[i] = radius * (1 + error_gamma(16)) + rounding;
  node.axis_x[i] = axis.x;
  node.axis_y[i] = axis.y;
  node.axis_z[i] = axis.z;
  node.cos_o[i] = float(std::cos(theta_o));
  // Never 0, so that sums of this angle and others beyond 180 degrees have a negative sine.
  node.sin_o[i] = std::max(1e-6f, float(std::sin(theta_o)));
  node.other_side[i] = two_sided ? -1.0f : 1.0f;
  node.intensity[i] = float(std::max(intensity / node_intensity, kLeastIntensity));
  node.reach[i] = reach * (1 + error_gamma(16)) + rounding;
}

}  // namespace

class LightTreeBuilder {
 public:
  explicit LightTreeBuilder(LightTree& tree) : tree_(tree) {}

  /// Appends the subtree of the items to `out`. `trail` leads there from the root.
  void build(std::span<Item> items, std::vector<LightTreeNode>& out, std::uint64_t trail, int depth) {
    const std::size_t self = out.size();
    out.emplace_back();
    const std::vector<Range> children = cut_into_children(items, depth);
    double intensity = 0;
    for (const Item& item : items) intensity += item.bounds.intensity;
    out[self].count = std::uint32_t(children.size());
    out[self].reach.fill(-1);  // of lanes that stay empty
    for (std::size_t i = 0; i < children.size(); ++i)
      set_bounds(out[self], int(i), children[i].items, intensity);

    const bool parallel = items.size() > kParallel;
    std::array<std::vector<LightTreeNode>, LightTreeNode::kWidth> subtrees;
    const auto build_child = [&](std::size_t i) {
      const std::span<Item> some = children[i].items;
      const std::uint64_t way = trail | std::uint64_t(i) << (LightTree::kBits * depth);
      if (some.size() > 1) return build(some, parallel ? subtrees[i] : out, way, depth + 1);
      tree_.trails_[some[0].light] = way;
    };
    if (parallel) parallel_for(children.size(), 1, build_child);
    for (std::size_t i = 0; i < children.size(); ++i) {
      const std::span<Item> some = children[i].items;
      out[self].link[i] = some.size() == 1 ? LightTreeNode::kLeaf | some[0].light : std::uint32_t(out.size());
      if (parallel) {
        append(out, subtrees[i]);
      } else {
        build_child(i);
      }
    }
  }

 private:
  /// Appends nodes, whose links count from the first of them.
  static void append(std::vector<LightTreeNode>& out, std::vector<LightTreeNode>& nodes) {
    const auto shift = std::uint32_t(out.size());
    for (LightTreeNode& node : nodes)
      for (std::uint32_t i = 0; i < node.count; ++i)
        if (!(node.link[i] & LightTreeNode::kLeaf)) node.link[i] += shift;
    out.insert(out.end(), nodes.begin(), nodes.end());
    nodes = {};
  }

  LightTree& tree_;
};

LightTree::LightTree(std::span<const LightBounds> lights) {
  std::vector<Item> items;
  items.reserve(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (!(lights[i].intensity > 0)) continue;
    total_ += lights[i].intensity;
    items.emplace_back(lights[i], lights[i].box.center(), std::uint32_t(i));
  }
  if (items.empty()) return;
  trails_.assign(lights.size(), kNoTrail);
  LightTreeBuilder(*this).build(items, nodes_, 0, 0);
  nodes_.shrink_to_fit();
}

}  // namespace parian
