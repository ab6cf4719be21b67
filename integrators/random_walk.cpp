#include "integrators/random_walk.h"

#include "integrators/boundary.h"
#include "renderer/base/sampling.h"

namespace parian {
namespace {

/// Multiplies the weight by f / pdf of a piece of which `transmitted` is what came to its end and `event`,
/// per metre, what happened there (1: nothing); the density of sampling it for channel k is rate[k]
/// transmitted[k], and the channel was chosen by what the weight was before.
void weigh(Rgb& weight, const Rgb& transmitted, const Rgb& event, const Rgb& rate) {
  const float sum = weight.x + weight.y + weight.z;
  const float pdf = weight.dot(rate * transmitted);
  weight = pdf > 0 ? weight * transmitted * event * (sum / pdf) : Rgb(0, 0, 0);
}

/// The channel in whose proportion of the weight u falls.
int choose_channel(const Rgb& weight, float u) {
  u *= weight.x + weight.y + weight.z;
  return u < weight.x ? 0 : u < weight.x + weight.y ? 1 : 2;
}

}  // namespace

Vec3f sample_henyey_greenstein(const Vec3f& d, float g, const Vec2f& u) {
  // 1 - cos, from the inverse of the distribution function without its differences of like numbers.
  const float a = 1 + g - 2 * g * u.x, s = (1 - g * g) / a;
  const float versine = std::clamp((1 - g) * u.x * (s + 1 - g) / a, 0.0f, 2.0f);
  const Vec2f p = unit_circle(u.y) * std::sqrt(versine * (2 - versine));
  return make_frame(d).to_world({p.x, p.y, 1 - versine});
}

Walk walk(const TraceContext& context, const Medium& medium, float lead, Ray& ray, Hit& hit, Rgb& weight,
          Sampler& sampler, RayCounts& counts) {
  const Rgb extinction = medium.extinction, nothing(1, 1, 1);
  int patience = kLongWalk;
  for (int steps = 0; steps < kLongestWalk; ++steps) {
    const int k = choose_channel(weight, sampler.next_independent());
    const float distance =
        extinction[k] > 0 ? -std::log(1 - sampler.next_independent()) / extinction[k] : kInfinity;
    // What would be scattered before the origin is scattered there.
    ray.tmax = std::max(distance - lead, 0.0f);
    ++counts.scattered;
    const bool met = context.accel.intersect(ray, sampler.key(), hit);
    if (met || distance == kInfinity) {
      weigh(weight, transmittance(&medium, met ? lead + hit.t : kInfinity), nothing, nothing);
      return steps == 0 ? Walk::straight : Walk::scattered;
    }
    weigh(weight, transmittance(&medium, distance), medium.scattering, extinction);
    lead = 0;
    // Without what is left to carry, absorption ends the path; else it would go on for ever, ever darker.
    const float survival = std::min(1.0f, max_component(weight));
    if (!(sampler.next_independent() < survival)) return Walk::ended;
    weight *= 1 / survival;
    if (steps == patience) {
      constexpr float kGoesOn = 0.70710678f;
      if (sampler.next_independent() >= kGoesOn) return Walk::ended;
      weight *= 1 / kGoesOn;
      patience *= 2;
    }
    const float choice = sampler.next_independent();
    ray.o += ray.d * ray.tmax;
    ray.d = sample_henyey_greenstein(ray.d, medium.anisotropy, {choice, sampler.next_independent()});
  }
  return Walk::ended;
}

}  // namespace parian
