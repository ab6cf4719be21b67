#include "integrators/boundary.h"

namespace parian {

std::optional<Boundary> find_boundary(const TraceContext& context, const MediumStack& media, const Ray& ray,
                                      std::uint32_t random, Hit& hit, Surface& surface) {
  const World& world = context.world;
  Boundary boundary{media.current(), nullptr, media};
  const Medium* const medium = world.medium(*surface.part);
  boundary.beyond.cross(hit.placement, medium, surface.front);

  // Two surfaces in one place are apart by the rounding of both.
  const float reach = 4 * surface.offset;
  const Vec3f n = surface.front ? surface.ng : -surface.ng;
  std::array<Hit, 16> near;
  const std::size_t count = context.accel.crossings({surface.p + n * reach, -n, 2 * reach}, random, near);
  for (const Hit& other : std::span(near).first(std::min(count, near.size()))) {
    if (other.placement == Hit::kAreaLightHit) continue;
    const Medium* const its = world.medium(hit_part(world, other));
    if (other.placement == hit.placement && its == medium) continue;
    if (!its) {
      const float t = hit.t;
      hit = other;
      hit.t = t;
      surface = make_surface(context.scene, world, hit, ray.d);
      return std::nullopt;
    }
    boundary.beyond.cross(other.placement, its, ray.d.dot(hit_normal(world, other)) < 0);
    surface.offset = reach;
  }
  boundary.after = boundary.beyond.current();
  return boundary;
}

Rgb transmittance(const Medium* medium, float distance) {
  if (!medium) return Rgb(1, 1, 1);
  const Rgb extinction = medium->extinction;
  Rgb left;
  for (int k = 0; k < 3; ++k) left[k] = extinction[k] > 0 ? std::exp(-extinction[k] * distance) : 1;
  return left;
}

}  // namespace parian
