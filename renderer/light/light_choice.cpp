#include "renderer/light/light_choice.h"

namespace parian {
namespace {

// The lights in the tree, and those that are not, are chosen with this probability at least, where they can
// reach the receiver: what is known of either is a bound or a mean, and what hides it is not known.
constexpr double kLeastShare = 0.1;

double importance(const InfiniteLight& light, const Receiver& to) {
  if (light.towards == Vec3f(0) || to.n == Vec3f(0)) return light.irradiance;
  return light.irradiance * std::max(0.0f, light.towards.dot(to.n));
}

}  // namespace

LightChooser::LightChooser(std::size_t count, const std::function<LightBounds(std::size_t)>& bounds_of,
                           std::vector<InfiniteLight> infinite)
    : by_place_(true), tree_(count, bounds_of), infinite_(std::move(infinite)) {
  std::erase_if(infinite_, [](const InfiniteLight& light) { return !(light.irradiance > 0); });
}

double LightChooser::infinite_importance(const Receiver& to) const {
  double sum = 0;
  for (const InfiniteLight& light : infinite_) sum += importance(light, to);
  return sum;
}

/// The probability that one of the infinite lights is chosen, whose importance is given. Both that and the
/// tree's are estimates of irradiance.
double LightChooser::infinite_share(const Receiver& to, double infinite) const {
  if (tree_.empty()) return 1;
  if (!(infinite > 0)) return 0;
  const double finite = tree_.importance(to);
  if (!(finite > 0)) return 1;
  return std::clamp(infinite / (infinite + finite), kLeastShare, 1 - kLeastShare);
}

LightChooser::Choice LightChooser::choose_by_place(const Receiver& to, double u) const {
  const double infinite = infinite_importance(to), share = infinite_share(to, infinite);
  const auto below_one = [](double x) { return std::clamp(float(x), 0.0f, 0x1.fffffep-1f); };
  if (u >= share) {
    const LightTree::Choice chosen =
        tree_.sample(to, std::min((u - share) / (1 - share), 0x1.fffffffffffffp-1));
    return {chosen.light, float((1 - share) * chosen.probability), below_one(chosen.remainder)};
  }
  // The last light that has any importance takes what rounding leaves.
  double rest = u / share * infinite;
  Choice choice{0, 0, 0};
  for (const InfiniteLight& light : infinite_) {
    const double part = importance(light, to);
    if (!(part > 0)) continue;
    choice = {light.light, float(share * part / infinite), below_one(rest / part)};
    if (rest < part) break;
    rest -= part;
  }
  return choice;
}

float LightChooser::probability_by_place(const Receiver& to, int light) const {
  const double infinite = infinite_importance(to), share = infinite_share(to, infinite);
  for (const InfiniteLight& candidate : infinite_)
    if (candidate.light == light)
      return infinite > 0 ? float(share * importance(candidate, to) / infinite) : 0;
  return tree_.empty() ? 0 : float((1 - share) * tree_.probability(to, light));
}

}  // namespace parian
