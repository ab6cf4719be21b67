#include "renderer/session/media.h"

#include <algorithm>
#include <map>
#include <vector>

namespace parian {
namespace {

/// A body by its medium, and how far away its last crossing is.
struct Around {
  std::uint32_t body;
  const Medium* medium;
  auto operator<=>(const Around&) const = default;
};

}  // namespace

MediumStack find_media(const World& world, const Accel& accel, const Vec3f& p) {
  MediumStack media;
  if (world.media.empty()) return media;
  std::map<Around, int> votes;
  std::map<Around, float> reach;  // how far its surface is, at most
  std::vector<Hit> hits(1024);
  for (const Vec3f& d :
       {Vec3f(0.36f, 0.48f, 0.8f), Vec3f(-0.8f, 0.36f, -0.48f), Vec3f(0.48f, -0.8f, -0.36f)}) {
    std::map<Around, int> left;
    const std::size_t count = accel.crossings({p, d}, 0, hits);
    for (const Hit& hit : std::span(hits).first(std::min(count, hits.size()))) {
      if (hit.placement == Hit::kAreaLightHit) continue;
      const Medium* medium = world.medium(hit_part(world, hit));
      if (!medium) continue;
      left[{hit.placement, medium}] += d.dot(hit_normal(world, hit)) > 0 ? 1 : -1;
      float& far = reach[{hit.placement, medium}];
      far = std::max(far, hit.t);
    }
    for (const auto& [body, count_left] : left) votes[body] += count_left > 0;
  }
  std::vector<Around> inside;
  for (const auto& [body, count] : votes)
    if (count >= 2) inside.push_back(body);
  // What reaches farther was entered first.
  std::ranges::stable_sort(inside, std::ranges::greater(), [&](const Around& body) { return reach[body]; });
  for (const Around& body : inside) media.cross(body.body, body.medium, true);
  return media;
}

}  // namespace parian
