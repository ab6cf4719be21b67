#include "integrators/path.h"

#include "integrators/boundary.h"
#include "integrators/features.h"
#include "integrators/random_walk.h"
#include "materials/dispersion.h"
#include "materials/subsurface_exit.h"
#include "renderer/base/sampling.h"

namespace parian {
namespace {

// A shadow ray ends this far, relative to its length, before the light: Embree's distance is good to some
// 1e-6.
constexpr float kShadowEnd = 1 - 1e-5f;

/// One path as it grows: its last ray and what that met are those of `camera`. `pdf` is the density per solid
/// angle of the ray's direction; infinite for the camera's, which no light sample competes with.
struct Path {
  CameraPath* camera;
  Rgb weight;
  float pdf;
  float trust;    // Tracer::trust() where it scattered last
  Receiver from;  // where it scattered last; not set where pdf is infinite
  // In a world with media:
  MediumStack media;  // around the path
  // An interface keeps L / n^2, not L: what the path finds counts as much as (n at the camera / n here)^2.
  float scale;
  float wavelength;  // nanometres; 0: of all
  int passed;        // surfaces that were none, since what is before and behind them is the same
  bool scattered;    // on its last ray, by a medium
  float lead;        // how far before its last ray's origin that would have left the surface

  const Ray& ray() const { return camera->ray; }
  const Hit& hit() const { return camera->hit; }
  Sampler& sampler() { return camera->sampler; }
  /// How far the last ray went, in metres.
  float distance() const { return hit().placement == Hit::kMiss ? kInfinity : hit().t; }
};

/// The numbers that every scattering takes.
struct Numbers {
  Vec2f light, direction;
};

/// What media a world has.
enum class Volumes : std::uint8_t { none, clear, scattering };

/// The steps of paths that grow side by side, in a world with media or without: one without has none of their
/// code in its way.
template <Volumes kVolumes>
class Tracer {
 public:
  static constexpr bool kMedia = kVolumes != Volumes::none, kScattering = kVolumes == Volumes::scattering;

  Tracer(const TraceContext& context, const IntegratorSettings& settings,
         std::span<const DiffuseMedium> diffuse_media, RayCounts& counts)
      : context_(context), settings_(settings), diffuse_media_(diffuse_media), counts_(counts) {}

  void set_out(Path& path, CameraPath& camera) const {
    path.camera = &camera;
    path.weight = Rgb(1, 1, 1);
    path.pdf = kInfinity;
    path.trust = 1;
    if constexpr (!kMedia) return;
    path.media = context_.camera_media;
    path.scale = 1;
    path.wavelength = 0;
    path.passed = 0;
    path.scattered = false;
    path.lead = 0;
  }

  /// What happens where the path has arrived after `depth` scattering events: light that it finds there,
  /// light that it samples, and where it goes. False where it ends.
  bool arrive(Path& path, int depth, const Numbers& numbers) {
    if constexpr (kMedia) absorb(path);
    const Rgb carried = kMedia ? path.weight * path.scale : path.weight;
    Rgb& radiance = path.camera->radiance;
    // A ray that leaves the scene, or ends at a light without a surface, brings what it sees there.
    if (path.hit().placement == Hit::kMiss) {
      radiance += carried * environment(path);
      return false;
    }
    if (path.hit().placement == Hit::kAreaLightHit) {
      radiance += carried * area_light(path);
      return false;
    }
    Surface surface = make_surface(context_.scene, context_.world, path.hit(), path.ray().d);
    std::optional<Boundary> boundary;
    if (kMedia && surface.part->medium != kNone) {
      if (surface.part->inside_out) turn(surface);
      boundary =
          find_boundary(context_, path.media, path.ray(), path.sampler().key(), path.camera->hit, surface);
      if (boundary && boundary->before == boundary->after) return pass(path, surface, *boundary);
    }
    if (surface.part->material->unlit) {
      radiance += carried * eval_base_color(context_.scene, surface);
      return false;
    }
    if (surface.part->emissive) radiance += carried * emission(path, surface);
    if constexpr (kMedia) depth -= path.passed;
    if (depth == settings_.max_depth) return false;

    // Scatter: light sampled directly, then a direction to go on.
    const float eta = boundary ? relative_ior(path, *boundary) : 1;
    const Bsdf bsdf = make_bsdf(context_.scene, surface, settings_.microfacets, eta);
    if constexpr (kScattering)
      if (boundary && leaves_anyhow(path, surface, *boundary))
        return leave_anyhow(path, surface, bsdf, *boundary, numbers.direction) && survive(path);
    sample_direct_light(path, surface, bsdf, boundary ? &*boundary : nullptr, numbers.light);
    if (const Rgb* weight = bsdf.constant_weight())
      return bounce(path, surface, bsdf, *weight, numbers.direction);
    if (!sample_direction(path, surface, bsdf, numbers.direction)) return false;
    if (boundary && bsdf.beyond(path.ray().d) && !enter(path, depth, surface, *boundary)) return false;
    return survive(path);
  }

  /// Adds the sampled light whose shadow rays nothing blocks.
  void add_direct_light() {
    if (shadow_rays_.count == 0) return;
    counts_.shadow += shadow_rays_.count;
    const std::uint32_t blocked = context_.accel.occluded(shadow_rays_);
    for (int i = 0; i < shadow_rays_.count; ++i)
      if (!(blocked >> i & 1)) waiting_[i]->camera->radiance += direct_[i];
    shadow_rays_.count = 0;
  }

  /// Follows a path to what it meets next.
  void follow(Path& path) {
    if constexpr (kScattering)
      if (const Medium* medium = path.media.current(); medium && medium->scatters())
        return wander(path, *medium);
    ++counts_.scattered;
    context_.accel.intersect(path.ray(), path.sampler().key(), path.camera->hit);
  }

 private:
  /// What the medium takes away on the last ray. (A walk has weighed that already.)
  void absorb(Path& path) const {
    const Medium* const medium = path.media.current();
    if (!medium || (kScattering && medium->scatters())) return;
    path.weight *= transmittance(medium, path.distance());
  }

  /// Follows a path through a medium that scatters it, to what it meets next; one that is absorbed meets
  /// nothing and carries nothing. Light is not sampled on the way: in most bodies their own surface hides it.
  void wander(Path& path, const Medium& medium) {
    const Walk result = walk(context_, medium, path.lead, path.camera->ray, path.camera->hit, path.weight,
                             path.sampler(), counts_);
    path.scattered = result != Walk::straight;
    if (!path.scattered) return;
    path.pdf = kInfinity;
    if (result == Walk::scattered) return;
    path.weight = Rgb(0, 0, 0);
    path.camera->hit.placement = Hit::kMiss;
  }

  /// Goes on where there is no boundary. No light sample could have found what comes: its ray ended here.
  bool pass(Path& path, const Surface& surface, const Boundary& boundary) const {
    constexpr int kMost = 1000;
    path.media = boundary.beyond;
    set_ray(path, surface, path.ray().d);
    path.pdf = kInfinity;
    return ++path.passed < kMost;
  }

  /// The index of refraction behind a boundary over that before it. Where it differs between wavelengths the
  /// path from here on is of one.
  float relative_ior(Path& path, const Boundary& boundary) const {
    const auto disperses = [](const Medium* medium) { return medium && medium->dispersion > 0; };
    if (path.wavelength == 0 && (disperses(boundary.before) || disperses(boundary.after))) {
      const float choice = path.sampler().next1();
      const WavelengthSample sample = sample_wavelength(choice, path.sampler().next2());
      path.wavelength = sample.wavelength;
      path.weight *= sample.weight;
    }
    return ior_of(boundary.after, path.wavelength) / ior_of(boundary.before, path.wavelength);
  }

  float scale_in(const Path& path, const Medium* medium) const {
    const float ratio =
        ior_of(context_.camera_media.current(), path.wavelength) / ior_of(medium, path.wavelength);
    return ratio * ratio;
  }

  /// Goes through a boundary; false where the path ends.
  bool enter(Path& path, int depth, const Surface& surface, const Boundary& boundary) {
    if constexpr (kScattering) {
      if (hides(&boundary)) {
        const DiffuseMedium& medium = diffuse_media_[std::size_t(surface.part->medium)];
        const bool alone = !boundary.before && boundary.after == context_.world.medium(*surface.part);
        const Inside inside =
            choose_inside(context_, settings_.subsurface, medium, surface, alone, path.sampler(), counts_);
        if (depth == 0)
          (inside == Inside::travels ? path.camera->features.walked : path.camera->features.diffused) = 1;
        if (inside != Inside::travels) return emerge(path, surface, medium, inside);
        path.pdf = kInfinity;  // what is inside, no light sample could have found
      }
    }
    path.media = boundary.beyond;
    path.scale = scale_in(path, boundary.after);
    return true;
  }

  /// Whether light is not sampled through a boundary, since what is behind is dense.
  static bool hides(const Boundary* boundary) {
    return boundary && boundary->after && boundary->after->dense && boundary->after->scatters();
  }

  /// Whether a path that has come through a dense body from inside may leave it in any direction, as diffused
  /// light does: then light can be sampled there, which a smooth interface lets no other path do. Only for
  /// Subsurface::automatic: light that was scattered often is as diffuse as that inside, and what the
  /// interface lets through of it is SubsurfaceExit; of light that was scattered once it is not.
  bool leaves_anyhow(const Path& path, const Surface& surface, const Boundary& boundary) const {
    return settings_.subsurface == Subsurface::automatic && path.scattered && !boundary.after &&
           boundary.before && boundary.before->dense &&
           boundary.before == context_.world.medium(*surface.part);
  }

  /// Goes on from inside a dense body's surface: back into it, or out by SubsurfaceExit.
  bool leave_anyhow(Path& path, const Surface& surface, const Bsdf& bsdf, const Boundary& boundary,
                    const Vec2f& u) {
    path.scattered = false;
    if (!sample_direction(path, surface, bsdf, u)) return false;
    if (!bsdf.beyond(path.ray().d)) return true;
    path.media = boundary.beyond;
    path.scale = scale_in(path, nullptr);
    Surface outside =
        make_surface(context_.scene, context_.world, path.hit(), surface.front ? surface.ng : -surface.ng);
    if (outside.part->inside_out) turn(outside);
    return leave(path, outside, diffuse_media_[std::size_t(surface.part->medium)], Rgb(1, 1, 1));
  }

  /// Goes on from where the light that went in at `surface` comes out of the body; false where the path ends.
  bool emerge(Path& path, const Surface& surface, const DiffuseMedium& medium, Inside inside) {
    if (inside == Inside::returns) {
      path.weight *= medium.reflectance;
      return leave(path, surface, medium, eval_crossing_tint(context_.scene, surface));
    }
    ++counts_.scattered;
    const std::optional<Emergence> place =
        sample_emergence(context_, medium, surface, path.hit(), path.weight, path.sampler());
    if (!place) return false;
    path.weight *= place->weight;
    return leave(path, place->surface, medium, eval_crossing_tint(context_.scene, place->surface));
  }

  /// Goes on from a surface that is seen from outside.
  bool leave(Path& path, const Surface& surface, const DiffuseMedium& medium, const Rgb& tint) {
    const Bsdf bsdf(surface, SubsurfaceExit{surface.part->material->ior, medium.inverse_c, tint});
    sample_direct_light(path, surface, bsdf, nullptr, path.sampler().next2());
    return sample_direction(path, surface, bsdf, path.sampler().next2());
  }

  /// The weight of light that the path ran into, where sampling lights would have found it with density
  /// `light_pdf`; the path's own density counts `trust` times.
  float hit_weight(const Path& path, float light_pdf, float trust = 1) const {
    if (path.pdf == kInfinity || settings_.strategy == Strategy::bsdf) return 1;
    if (settings_.strategy == Strategy::light) return light_pdf > 0 ? 0.0f : 1.0f;
    return power_heuristic(path.pdf * trust, light_pdf);
  }

  Rgb environment(const Path& path) const {
    const EnvironmentLight& environment = context_.lights.environment();
    if (environment.black()) return Rgb(0, 0, 0);
    if (path.pdf == kInfinity) return environment.eval(path.ray().d);
    const EnvironmentSample seen = context_.lights.look_up_environment(path.ray().d, path.from);
    return seen.radiance * hit_weight(path, seen.pdf);
  }

  Rgb area_light(const Path& path) const {
    const AreaLight& light = context_.world.area_lights[path.hit().triangle];
    const float cosine = -path.ray().d.dot(light.normal);
    if (cosine <= 0) return Rgb(0, 0, 0);
    const float competing =
        path.pdf == kInfinity ? 0 : context_.lights.pdf_area_light(path.hit(), path.from, cosine);
    return light.radiance * hit_weight(path, competing, path.trust);
  }

  Rgb emission(const Path& path, const Surface& surface) const {
    const Material& material = *surface.part->material;
    if (!surface.front && !material.double_sided) return Rgb(0, 0, 0);
    const float cosine = std::abs(path.ray().d.dot(surface.ng));
    float competing = 0;
    if (path.pdf != kInfinity && cosine != 0)
      competing = path.hit().is_solid() ? context_.lights.pdf_solid(path.hit(), path.from, cosine)
                                        : context_.lights.pdf_triangle(path.hit(), path.from, cosine);
    return eval_emission(context_.scene, material, surface.uvs, cosine) *
           hit_weight(path, competing, path.trust);
  }

  /// Samples a point of a light; whether it is seen is for later.
  void sample_direct_light(Path& path, const Surface& surface, const Bsdf& bsdf, const Boundary* boundary,
                           const Vec2f& u) {
    const bool one_sided = !bsdf.transmits() || (kScattering && hides(boundary));
    path.from = {surface.lifted ? surface.p + surface.lift : surface.p,
                 one_sided ? surface.frame.z : Vec3f(0)};
    if (context_.lights.empty()) return;
    const std::optional<LightSample> light = context_.lights.sample(path.from, u, path.sampler());
    if (!light) return;
    if (!light->delta && settings_.strategy == Strategy::bsdf) return;
    if (kScattering && hides(boundary) && bsdf.beyond(light->wi)) return;
    const BsdfValue value = bsdf.eval(light->wi);
    if (is_black(value.f_cos)) return;
    const bool alone = light->delta || settings_.strategy == Strategy::light;
    const Rgb scattered = path.weight * value.f_cos;
    // The density of a path that goes on in this direction and survives().
    const float competing =
        std::min(value.pdf, max_component(scattered)) * (light->at_infinity ? 1 : trust(bsdf));
    Rgb direct = scattered * light->radiance *
                 (alone ? 1 / light->pdf : power_heuristic_over_pdf(light->pdf, competing));
    if (is_black(direct)) return;
    const Vec3f origin = ray_origin(surface, light->wi);
    if constexpr (kMedia) {
      const Medium* medium = path.media.current();
      float scale = path.scale;
      if (boundary && bsdf.beyond(light->wi)) {
        medium = boundary->after;
        scale = scale_in(path, medium);
      }
      direct *= scale;
      if (medium)
        direct *= transmittance(medium, light->at_infinity ? kInfinity : (light->target - origin).length());
      if (is_black(direct)) return;
    }
    // A path that enters a body and leaves it asks twice.
    if (kScattering && shadow_rays_.count == RayPacket::kSize) add_direct_light();
    waiting_[shadow_rays_.count] = &path;
    direct_[shadow_rays_.count] = direct;
    shadow_rays_.add(
        light->at_infinity ? Ray{origin, light->wi} : Ray{origin, light->target - origin, kShadowEnd},
        path.sampler().key());
  }

  /// Sends the path from a surface along w.
  static void set_ray(Path& path, const Surface& surface, const Vec3f& w) {
    path.camera->ray = {ray_origin(surface, w), w};
    if constexpr (kScattering) path.lead = surface.offset / std::max(std::abs(w.dot(surface.ng)), 1e-3f);
  }

  /// Goes on in a direction sampled from the BSDF; false where the path ends.
  bool sample_direction(Path& path, const Surface& surface, const Bsdf& bsdf, const Vec2f& u) const {
    const float choice = bsdf.has_choice() ? path.sampler().next1() : 0;
    const std::optional<BsdfSample> sample = bsdf.sample(choice, u);
    if (!sample) return false;
    path.weight *= sample->weight;
    path.pdf = sample->pdf;
    path.trust = trust(bsdf);
    set_ray(path, surface, sample->wi);
    return true;
  }

  /// Goes on from a surface whose samples all have one weight; false where the path ends. There survive() is
  /// decided before the direction is, by a number that, stretched, serves for the direction too: both are
  /// stratified together.
  bool bounce(Path& path, const Surface& surface, const Bsdf& bsdf, const Rgb& weight, const Vec2f& u) const {
    const Rgb carried = path.weight * weight;
    const float survival = std::min(1.0f, max_component(carried));
    if (u.x >= survival) return false;
    const std::optional<BsdfSample> sample = bsdf.sample(0, {std::min(u.x / survival, 0x1.fffffep-1f), u.y});
    if (!sample) return false;
    path.weight = carried * (1 / survival);
    path.pdf = sample->pdf * survival;
    path.trust = trust(bsdf);
    set_ray(path, surface, sample->wi);
    return true;
  }

  /// Russian roulette by what the path still carries: the survivors' weights make up for the others. By a
  /// stratified number: with another, all light that directions find has the noise of roulette. Without
  /// branches: the outcome is chance, and a branch on chance is mispredicted.
  bool survive(Path& path) const {
    const float survival = std::min(1.0f, max_component(path.weight));
    path.weight *= 1 / survival;
    path.pdf *= survival;
    return path.sampler().next1() < survival;
  }

  /// What the density of directions counts in the weights of both strategies for lights that have a place.
  /// Where a surface is diffuse, samples of such a light are stratified samples of a smooth function, and the
  /// power heuristic, which knows densities only, trusts them too little. A sky is found as well by
  /// directions.
  static float trust(const Bsdf& bsdf) { return bsdf.has_choice() ? 1.0f : 0.4f; }

  const TraceContext& context_;
  const IntegratorSettings& settings_;
  std::span<const DiffuseMedium> diffuse_media_;
  RayCounts& counts_;
  RayPacket shadow_rays_;
  // Whose light the shadow rays ask about, and how much it is unless something lies between.
  std::array<Path*, RayPacket::kSize> waiting_;
  std::array<Rgb, RayPacket::kSize> direct_;
};

/// PathIntegrator::estimate().
template <Volumes kVolumes>
void trace(const TraceContext& context, const IntegratorSettings& settings,
           std::span<const DiffuseMedium> diffuse_media, std::span<CameraPath> camera_paths,
           RayCounts& counts, bool features_wanted) {
  std::array<Path, RayPacket::kSize> paths;
  std::array<Path*, RayPacket::kSize> growing;
  std::array<Sampler*, RayPacket::kSize> samplers;  // of the growing paths
  std::size_t count = 0;
  Tracer<kVolumes> tracer(context, settings, diffuse_media, counts);
  for (CameraPath& camera : camera_paths) {
    if (features_wanted && camera.hit.placement != Hit::kMiss)
      camera.features = hit_features(context, camera.hit, camera.ray.d);
    Path& path = paths[count];
    tracer.set_out(path, camera);
    samplers[count] = &camera.sampler;
    growing[count++] = &path;
  }

  for (int depth = 0; count > 0; ++depth) {
    std::array<Vec2f, RayPacket::kSize> light, direction;
    next2_twice({samplers.data(), count}, light.data(), direction.data());
    // Those that go on move to the front, without a branch on whether they do.
    std::size_t left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      Path& path = *growing[i];
      const bool goes_on = tracer.arrive(path, depth, {light[i], direction[i]});
      growing[left] = &path;
      samplers[left] = &path.sampler();
      left += goes_on;
    }
    count = left;
    tracer.add_direct_light();
    for (std::size_t i = 0; i < count; ++i) tracer.follow(*growing[i]);
  }
  if (settings.clamp < kInfinity)
    for (CameraPath& camera : camera_paths) {
      const float largest = max_component(camera.radiance);
      if (largest > settings.clamp) camera.radiance *= settings.clamp / largest;
    }
}

}  // namespace

void PathIntegrator::prepare(const World& world) {
  if (world.media == media_) return;  // most edits leave them, and tables take milliseconds
  media_ = world.media;
  diffuse_media_.clear();
  if (std::ranges::any_of(world.media, &Medium::scatters))
    diffuse_media_ = make_diffuse_media(world, settings_.subsurface);
}

void PathIntegrator::estimate(const TraceContext& context, std::span<CameraPath> camera_paths,
                              RayCounts& counts, bool features_wanted) const {
  const auto trace_volumes = !diffuse_media_.empty()       ? trace<Volumes::scattering>
                             : context.world.media.empty() ? trace<Volumes::none>
                                                           : trace<Volumes::clear>;
  trace_volumes(context, settings_, diffuse_media_, camera_paths, counts, features_wanted);
}

}  // namespace parian
