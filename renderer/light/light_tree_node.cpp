#include "renderer/light/light_tree_node.h"

#include <optional>

#include "renderer/base/parallel.h"

namespace parian {
namespace {

using Item = LightTreeItem;

// Children of more lights than this are bounded in parallel.
constexpr std::size_t kParallel = 4096;
// No child has less than this part of a node's intensity: below, numbers would underflow.
constexpr double kLeastIntensity = 1e-30;
constexpr double kOne = LightTreeNode::kOne;
// Steps of the cosine of theta_e below its value, where that is not 0: the three numbers of an axis are half
// a step off, cos_o and sin_o one each.
constexpr int kStepsBelow = 3;

double angle(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

/// What one walk over the lights of a child tells.
struct Sums {
  Box3f box;
  double intensity = 0;
  Vec3d axes{0, 0, 0};
  float cos_e = 1;
  bool two_sided = false;

  explicit Sums(std::span<const Item> items) {
    for (const Item& item : items) {
      const LightBounds& light = item.bounds;
      box.extendBy(light.box);
      intensity += double(light.intensity);
      const Vec3d axis(light.axis);
      axes += light.two_sided && axes.dot(axis) < 0 ? -axis : axis;
      cos_e = std::min(cos_e, light.cos_e);
      two_sided |= light.two_sided;
    }
  }
};

/// The cosine of the half angle of the cone around a unit axis that holds those of all items.
double cone_around(const Vec3d& axis, std::span<const Item> items) {
  double least = 1, widest = 0;
  for (const Item& item : items) {
    const LightBounds& light = item.bounds;
    double cosine = axis.dot(Vec3d(light.axis));
    if (light.two_sided) cosine = std::abs(cosine);
    if (light.cos_o == 1) {
      least = std::min(least, cosine);
    } else {
      widest = std::max(widest, angle(cosine) + angle(double(light.cos_o)));
    }
  }
  // Most are flat, and need no angle.
  return widest > 0 ? std::cos(std::min(std::max(widest, angle(least)), std::numbers::pi)) : least;
}

std::uint32_t words(std::int64_t low, std::int64_t high) {
  return (std::uint32_t(low) & 0xffffu) | std::uint32_t(high) << 16;
}

std::int64_t round_down(double x) { return std::int64_t(std::max(std::floor(x * kOne), -kOne)); }

std::uint32_t short_float(float x) { return (std::bit_cast<std::uint32_t>(x) + 0x4000u) >> 15; }
std::uint32_t short_float_above(float x) { return (std::bit_cast<std::uint32_t>(x) + 0x7fffu) >> 15; }

void set_cone(LightTreeNode& node, int i, const Sums& sums, std::span<const Item> items) {
  const bool one = items.size() == 1;
  const Vec3d axis = one ? Vec3d(items[0].bounds.axis) : sums.axes.normalized();
  const double cos_o = std::clamp(one ? double(items[0].bounds.cos_o) : cone_around(axis, items), -1.0, 1.0);
  const double sin_o = std::sqrt((1 - cos_o) * (1 + cos_o));
  std::int64_t cos_e = round_down(double(sums.cos_e));
  if (cos_e > 0) cos_e = std::max<std::int64_t>(cos_e - kStepsBelow, 0);
  // Never 0, so that sums of this angle and others beyond 180 degrees have a negative sine.
  const auto sine = std::int64_t(std::clamp(std::ceil(sin_o * kOne), 1.0, kOne));
  node.axis_xy[i] = words(std::lrint(axis.x * kOne), std::lrint(axis.y * kOne));
  node.axis_z_cos_o[i] = words(std::lrint(axis.z * kOne), round_down(cos_o));
  node.sin_o_cos_e[i] = words(sine | (sums.two_sided ? LightTreeNode::kTwoSided : 0), cos_e);
}

/// The centre, rounded to the node's grid, and the distances from there.
void set_sphere(LightTreeNode& node, int i, const Sums& sums, std::span<const Item> items, double intensity,
                float rounding) {
  const Vec3f at = node.cell > 0 ? (sums.box.center() - node.origin) / node.cell : Vec3f(0);
  const auto cell_of = [](float x) { return std::int64_t(std::clamp(x + 0.5f, 0.0f, 65535.0f)); };
  const std::int64_t x = cell_of(at.x), y = cell_of(at.y), z = cell_of(at.z);
  const Vec3f center = node.origin + Vec3f(float(x), float(y), float(z)) * node.cell;
  float furthest2 = 0, reach = 0;
  for (const Item& item : items) {
    const LightBounds& light = item.bounds;
    const Vec3f corner = max(abs(light.box.min - center), abs(light.box.max - center));
    const float distance2 = corner.dot(corner);
    furthest2 = std::max(furthest2, distance2);
    reach = light.range < kInfinity ? std::max(reach, std::sqrt(distance2) + light.range) : kInfinity;
  }
  constexpr float kLarger = 1 + error_gamma(16);
  node.center_xy[i] = words(x, y);
  node.center_z_radius[i] = words(z, short_float_above(std::sqrt(furthest2) * kLarger + rounding));
  node.intensity_reach[i] = words(short_float(float(std::max(sums.intensity / intensity, kLeastIntensity))),
                                  short_float_above(reach * kLarger + rounding));
}

}  // namespace

void set_bounds(LightTreeNode& node, std::span<const std::span<Item>> children) {
  const std::size_t count = children.size();
  std::size_t lights = 0;
  for (const std::span<Item> child : children) lights += child.size();
  const auto for_each_child = [&](const auto& body) {
    if (lights > kParallel) return parallel_for(count, 1, body);
    for (std::size_t i = 0; i < count; ++i) body(i);
  };
  std::array<std::optional<Sums>, LightTreeNode::kWidth> sums;
  for_each_child([&](std::size_t i) { sums[i].emplace(children[i]); });
  Box3f box, centers;
  double intensity = 0;
  for (std::size_t i = 0; i < count; ++i) {
    box.extendBy(sums[i]->box);
    centers.extendBy(sums[i]->box.center());
    intensity += sums[i]->intensity;
  }
  node.count = std::uint32_t(count);
  node.origin = centers.min;
  node.cell = max_component(centers.size()) / 65535;
  // Points of a light are rounded: 16 times, as plane_offset() has it, from the largest coordinate; its
  // centre as it is used 4 times.
  const float rounding = error_gamma(20) * max_component(max(abs(box.min), abs(box.max)));
  for_each_child([&](std::size_t i) {
    set_sphere(node, int(i), *sums[i], children[i], intensity, rounding);
    set_cone(node, int(i), *sums[i], children[i]);
  });
}

}  // namespace parian
