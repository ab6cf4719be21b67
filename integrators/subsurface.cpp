#include "integrators/subsurface.h"

#include "materials/diffusion.h"
#include "materials/subsurface_exit.h"
#include "renderer/base/sampling.h"
#include "renderer/scene/fresnel.h"
#include "renderer/scene/half_space.h"

namespace parian {
namespace {

// In units of DiffuseMedium::blur: how deep a body must be for diffusion to take the place of a walk. Balls
// and slabs of any size then give back what a walk would within 6% (docs/subsurface.md).
constexpr float kBroad = 10;

Diffusion model_of(Subsurface method) {
  switch (method) {
    case Subsurface::dipole:
      return Diffusion::dipole;
    case Subsurface::better_dipole:
      return Diffusion::better_dipole;
    case Subsurface::burley:
      return Diffusion::burley;
    default:
      return Diffusion::photon_beam;
  }
}

/// What a thick flat body gives back of light that has got in, one channel.
double reflectance_of(const Medium& medium, double albedo) {
  if (!medium.diffuse_interface) return half_space_reflectance(albedo, medium.ior);
  return diffuse_half_space_reflectance(albedo, 2 * fresnel_moment(medium.ior, 1));
}

DiffuseMedium make_diffuse_medium(const Medium& medium, Subsurface method) {
  DiffuseMedium result{{}, Rgb(0, 0, 0), 0, 0, kInfinity};
  if (medium.ior < 1) return result;  // 0: infinite, nothing gets in
  result.inverse_c = SubsurfaceExit::make_inverse_c(medium.ior);
  // The models are for light that goes in at normal incidence: where an interface spreads it, their shape
  // alone is of use.
  const bool scaled = method == Subsurface::automatic || medium.diffuse_interface;
  const float eta = medium.diffuse_interface ? 1 : medium.ior;
  for (int k = 0; k < 3; ++k) {
    const float absorption = medium.absorption[k], scattering = medium.reduced_scattering()[k];
    if (scattering == 0) continue;
    const double extinction = double(absorption) + scattering;
    const double reflectance = reflectance_of(medium, scattering / extinction);
    result.profiles[std::size_t(k)] = make_profile(model_of(method), absorption, scattering, eta,
                                                   scaled ? std::optional(reflectance) : std::nullopt);
    result.reflectance[k] = float(reflectance);
    const double diffusion_length = 1 / std::sqrt(3 * absorption * extinction);
    result.blur = std::max(result.blur, float(diffusion_length + 1 / extinction));
    result.free_path = std::min(result.free_path, float(1 / extinction));
  }
  return result;
}

/// The axes of a probe, the normal first, and the probabilities with which they are taken.
struct Axes {
  Frame frame;
  static constexpr std::array<float, 3> kProbability{0.5f, 0.25f, 0.25f};

  const Vec3f& operator[](int i) const { return i == 0 ? frame.z : i == 1 ? frame.x : frame.y; }
};

/// One probe and all that it may have been instead.
class Probe {
 public:
  Probe(const DiffuseMedium& medium, const Surface& entry, const Rgb& carried, Sampler& sampler)
      : medium_(medium), from_(entry.p), axes_{make_frame(entry.ng)} {
    float sum = 0;
    for (int k = 0; k < 3; ++k) sum += share_[k] = carried[k] * medium.profiles[std::size_t(k)].total();
    share_ *= sum > 0 ? 1 / sum : 0;
    const float u = sampler.next1(), channel = sampler.next1();
    axis_ = u < 0.5f ? 0 : u < 0.75f ? 1 : 2;
    const RadialProfile& profile = medium.profiles[channel < share_.x              ? 0
                                                   : channel < share_.x + share_.y ? 1
                                                                                   : 2];
    const Vec2f place = sampler.next2();
    const float r = profile.sample(place.x), reach = profile.max_radius();
    half_ = std::sqrt(std::max(0.0f, (reach - r) * (reach + r)));
    const Vec2f p = unit_circle(place.y) * r;
    centre_ = from_ + axes_[(axis_ + 1) % 3] * p.x + axes_[(axis_ + 2) % 3] * p.y;
  }

  bool reaches_anything() const { return half_ > 0; }
  Ray ray() const { return {centre_ - axes_[axis_] * half_, axes_[axis_], 2 * half_}; }

  /// The profile at the place where the probe crosses a surface of unit normal n at distance t, over the
  /// density per area of that surface with which probes find it.
  Rgb weight(float t, const Vec3f& n) const {
    const Vec3f d = centre_ + axes_[axis_] * (t - half_) - from_;
    const float distance2 = d.dot(d), distance = std::sqrt(distance2);
    std::array<float, 3> radius, slant;
    for (int a = 0; a < 3; ++a) {
      const float along = d.dot(axes_[a]);
      radius[std::size_t(a)] = std::sqrt(std::max(0.0f, distance2 - along * along));
      slant[std::size_t(a)] = Axes::kProbability[std::size_t(a)] * std::abs(n.dot(axes_[a]));
    }
    float pdf = 0;
    Rgb profile;
    for (int k = 0; k < 3; ++k) {
      const RadialProfile& channel = medium_.profiles[std::size_t(k)];
      profile[k] = channel.eval(distance);
      if (share_[k] == 0 || distance >= channel.max_radius()) continue;
      for (std::size_t a = 0; a < 3; ++a) pdf += share_[k] * slant[a] * channel.pdf(radius[a]);
    }
    return pdf > 0 ? profile * (1 / pdf) : Rgb(0, 0, 0);
  }

 private:
  const DiffuseMedium& medium_;
  Vec3f from_, centre_;
  Axes axes_;
  Rgb share_{0, 0, 0};  // the probability of each channel
  int axis_;
  float half_;  // of the probe's length
};

}  // namespace

std::vector<DiffuseMedium> make_diffuse_media(const World& world, Subsurface method) {
  std::vector<DiffuseMedium> media;
  for (const Medium& medium : world.media) media.push_back(make_diffuse_medium(medium, method));
  return media;
}

Inside choose_inside(const TraceContext& context, Subsurface method, const DiffuseMedium& medium,
                     const Surface& surface, bool alone, Sampler& sampler, RayCounts& counts) {
  constexpr float kResolved = 16;  // roundings
  if (method == Subsurface::off || medium.free_path < kResolved * surface.offset) return Inside::returns;
  if (method == Subsurface::random_walk || !alone) return Inside::travels;
  if (method != Subsurface::automatic) return Inside::diffuses;
  const float depth = kBroad * medium.blur;
  if (!(depth < kInfinity)) return Inside::travels;
  const Frame frame = make_frame(surface.front ? -surface.ng : surface.ng);
  const Vec3f d = frame.to_world(sample_cosine_hemisphere(sampler.next2()));
  ++counts.shadow;
  const bool near = context.accel.occluded({ray_origin(surface, d), d, depth}, sampler.key());
  return near ? Inside::travels : Inside::diffuses;
}

std::optional<Emergence> sample_emergence(const TraceContext& context, const DiffuseMedium& medium,
                                          const Surface& entry, const Hit& hit, const Rgb& carried,
                                          Sampler& sampler) {
  const Probe probe(medium, entry, carried, sampler);
  if (!probe.reaches_anything()) return std::nullopt;
  // Where it crosses more than there is room for, those kept stand for the others.
  std::array<Hit, 16> crossings;
  const Body body{hit.placement, entry.part->medium};
  const std::size_t all = context.accel.crossings(probe.ray(), sampler.key(), crossings, &body),
                    kept = std::min(all, crossings.size());
  float sum = 0, u = sampler.next_independent();
  Rgb weight(0, 0, 0);
  Hit chosen{};
  Vec3f normal(0);
  for (std::size_t i = 0; i < kept; ++i) {
    const Vec3f n = hit_normal(context.world, crossings[i]);
    const float length = n.length();
    if (!(length > 0)) continue;
    const Rgb w = probe.weight(crossings[i].t, n / length);
    const float contribution = carried.dot(w);
    if (!(contribution > 0)) continue;
    // One of them in proportion to its contribution, with one number for all (Chao 1982).
    sum += contribution;
    const float p = contribution / sum;
    if (u < p) {
      u /= p;
      weight = w * (1 / contribution);
      chosen = crossings[i];
      normal = n / length;
    } else {
      u = (u - p) / (1 - p);
    }
  }
  if (sum == 0) return std::nullopt;
  Emergence place{make_surface(context.scene, context.world, chosen, entry.front ? -normal : normal),
                  weight * (sum * float(all) / float(kept))};
  if (place.surface.part->inside_out) turn(place.surface);
  return place;
}

}  // namespace parian
