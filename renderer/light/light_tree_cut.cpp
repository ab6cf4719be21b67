/// The surface area orientation heuristic (Conty Estevez and Kulla 2018, 4.2).
#include "renderer/light/light_tree_cut.h"

#include <algorithm>

namespace parian {
namespace {

using Item = LightTreeItem;
using Range = LightTreeRange;

constexpr int kBuckets = 12;
// The cut of a larger set is found from a part of its items, of this number and up to twice that: what the
// others would change is far below what a bucket more or less is worth.
constexpr std::size_t kSampled = 1024;
// Packed halves of sets up to this size are multiples of a node's width.
constexpr std::size_t kRounded = 512;

/// Twice the centre.
Vec3f place(const Item& item) { return item.bounds.box.min + item.bounds.box.max; }

/// The measure of directions in which lights of a cone shine, each weighted by its cosine (Conty Estevez and
/// Kulla 2018, equation 1).
double orientation_measure(double cos_o, double cos_e) {
  const double pi = std::numbers::pi, sin_o = std::sqrt(std::max(0.0, (1 - cos_o) * (1 + cos_o)));
  // Of flat and point lights, without most of the functions.
  if (cos_e == 0 && cos_o >= 0) return 2 * pi - pi * cos_o + 0.5 * pi * pi * sin_o;
  const double theta_o = std::acos(cos_o);
  if (cos_e == 0) return 2 * pi * (1 - cos_o) + pi * (pi - theta_o) * sin_o;
  const double theta_w = std::min(theta_o + std::acos(cos_e), pi);
  return 2 * pi * (1 - cos_o) +
         pi / 2 * (2 * theta_w * sin_o - std::cos(theta_o - 2 * theta_w) - 2 * theta_o * sin_o + cos_o);
}

/// What the heuristic needs of a set of lights; sets add up.
struct LightSet {
  Box3f box;
  Vec3f axes{0, 0, 0};  // sum of the mean directions of their cones
  float cos_e = 1;
  double intensity = 0;
  std::size_t count = 0;

  void add(const LightBounds& light, const Vec3f& axis) {
    box.min = {std::min(box.min.x, light.box.min.x), std::min(box.min.y, light.box.min.y),
               std::min(box.min.z, light.box.min.z)};
    box.max = max(box.max, light.box.max);
    axes += axis;
    cos_e = std::min(cos_e, light.cos_e);
    intensity += double(light.intensity);
    ++count;
  }
  void add(const LightSet& other) {
    box.extendBy(other.box);
    axes += other.axes;
    cos_e = std::min(cos_e, other.cos_e);
    intensity += other.intensity;
    count += other.count;
  }
  /// The heuristic's cost. Instead of the area of the box, that of the sphere around it, which is what a node
  /// keeps and is not 0 for lights on a line. Instead of a cone around all axes, which needs one more pass
  /// for each way to cut, the cone whose directions have a mean of the same length: (1 + cos theta_o) / 2.
  double cost() const {
    const Vec3f size = box.size();
    const double spread = double(axes.length()) / double(count);
    return intensity * double(size.dot(size)) *
           orientation_measure(2 * std::min(spread, 1.0) - 1, double(std::clamp(cos_e, -1.0f, 1.0f)));
  }
};

/// Two sets out of one: the items whose centres are in lower buckets along the axis, and the others.
struct Cut {
  int axis = -1;   // none was found
  int bucket = 0;  // the first of the second set
  std::array<double, 2> cost{};
};

/// The grid of buckets over the box of all places.
struct Buckets {
  Vec3f origin, scale;
  explicit Buckets(const Box3f& places) : origin(places.min) {
    const Vec3f size = places.size();
    for (int k = 0; k < 3; ++k) scale[k] = size[k] > 0 ? kBuckets / size[k] : 0;
  }
  int index(const Vec3f& at, int axis) const {
    return int(std::clamp((at[axis] - origin[axis]) * scale[axis], 0.0f, float(kBuckets - 1)));
  }
};

using Sets = std::array<LightSet, kBuckets>;

/// The best cut along one axis, if it is better than the best up to now, which is of cost `least`.
void improve(const Sets& sets, std::size_t total, double thinness, int axis, double& least, Cut& best) {
  std::array<double, kBuckets> cost{};  // of the buckets from each on
  LightSet after, before;
  for (int i = kBuckets - 1; i > 0; --i) {
    if (sets[i].count > 0) {
      after.add(sets[i]);
      cost[i] = after.cost();
    } else if (i + 1 < kBuckets) {
      cost[i] = cost[i + 1];
    }
  }
  double cost_before = 0;
  for (int i = 1; i < kBuckets; ++i) {
    if (sets[i - 1].count == 0) continue;
    before.add(sets[i - 1]);
    if (before.count == total) break;
    cost_before = before.cost();
    const double both = (cost_before + cost[i]) * thinness;
    if (!(both < least)) continue;
    least = both;
    best = {axis, i, {cost_before, cost[i]}};
  }
}

Cut best_cut(std::span<const Item> items, std::size_t step, const Buckets& buckets, const Vec3f& size) {
  std::array<Sets, 3> sets;
  const Vec3f reference = items[0].bounds.axis;
  std::size_t total = 0;
  for (std::size_t i = 0; i < items.size(); i += step, ++total) {
    const LightBounds& light = items[i].bounds;
    Vec3f axis = light.cos_o == 1 ? light.axis : light.axis * (0.5f * (1 + light.cos_o));
    if (light.two_sided && light.axis.dot(reference) < 0) axis = -axis;
    const Vec3f at = place(items[i]);
    for (int k = 0; k < 3; ++k) sets[k][buckets.index(at, k)].add(light, axis);
  }
  Cut best;
  double least = std::numeric_limits<double>::infinity();
  // Thin halves are discouraged.
  for (int k = 0; k < 3; ++k)
    if (size[k] > 0) improve(sets[k], total, double(max_component(size) / size[k]), k, least, best);
  for (double& cost : best.cost) cost *= double(step);
  return best;
}

/// Puts those of the least places along the axis first.
void put_first(std::span<Item> items, std::size_t count, int axis) {
  std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(count), items.end(),
                   [&](const Item& a, const Item& b) { return place(a)[axis] < place(b)[axis]; });
}

/// The multiple of a node's width that is nearest to `first`, none of both parts being empty.
std::size_t rounded(std::size_t first, std::size_t count) {
  constexpr std::size_t kWidth = LightTreeNode::kWidth;
  return std::clamp((first + kWidth / 2) / kWidth * kWidth, kWidth, (count - 1) / kWidth * kWidth);
}

}  // namespace

std::array<Range, 2> cut(std::span<Item> items, LightTreeCut how) {
  const std::size_t count = items.size();
  const auto at = [&](std::size_t first, const std::array<double, 2>& cost) {
    return std::array<Range, 2>{Range{items.first(first), cost[0]}, Range{items.subspan(first), cost[1]}};
  };
  if (count == 2) return at(1, {});
  const std::size_t step = count < 2 * kSampled ? 1 : (count / kSampled) | 1;
  Box3f places;
  for (std::size_t i = 0; i < count; i += step) places.extendBy(place(items[i]));
  const Vec3f size = places.size();
  constexpr std::size_t kWidth = LightTreeNode::kWidth;
  const bool round = how == LightTreeCut::packed && count <= kRounded && count > kWidth;
  // Of two nodes full there is but one place to cut.
  if (how != LightTreeCut::halves && !(round && count <= 2 * kWidth)) {
    const Buckets buckets(places);
    if (const Cut best = best_cut(items, step, buckets, size); best.axis >= 0) {
      const auto second = std::partition(items.begin(), items.end(), [&](const Item& item) {
        return buckets.index(place(item), best.axis) < best.bucket;
      });
      const auto first = std::size_t(second - items.begin());
      if (!round) return at(first, best.cost);
      const std::size_t wanted = rounded(first, count);
      if (wanted < first) put_first(items.first(first), wanted, best.axis);
      if (wanted > first) put_first(items.subspan(first), wanted - first, best.axis);
      return at(wanted, best.cost);
    }
  }
  const int widest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::size_t middle = round ? rounded(count / 2, count) : count / 2;
  put_first(items, middle, widest);
  // Of halves alike the larger is cut next.
  return at(middle, {double(middle), double(count - middle)});
}

}  // namespace parian
