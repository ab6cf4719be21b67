#include "integrators/path.h"

#include "integrators/features.h"
#include "renderer/base/sampling.h"

namespace parian {
namespace {

// A shadow ray ends this far, relative to its length, before the light: Embree's distance is good to some
// 1e-6.
constexpr float kShadowEnd = 1 - 1e-5f;

/// One path as it grows. `pdf` is the density per solid angle of its last direction; infinite for the
/// camera's, which no light sample competes with.
struct Path {
  const TraceContext& context;
  const IntegratorSettings& settings;
  Sampler& sampler;
  RayCounts& counts;
  Ray ray;
  Rgb weight{1, 1, 1}, radiance{0, 0, 0};
  float pdf = kInfinity;

  /// The weight of light that the path ran into, where sampling lights would have found it with density
  /// `light_pdf`.
  float hit_weight(float light_pdf) const {
    if (pdf == kInfinity || settings.strategy == Strategy::bsdf) return 1;
    if (settings.strategy == Strategy::light) return light_pdf > 0 ? 0.0f : 1.0f;
    return power_heuristic(pdf, light_pdf);
  }

  void add_environment() {
    const EnvironmentLight& environment = context.lights.environment();
    if (environment.black()) return;
    const float competing = pdf == kInfinity ? 0 : context.lights.pdf_environment(ray.d);
    radiance += weight * environment.eval(ray.d) * hit_weight(competing);
  }

  void add_area_light(const Hit& hit) {
    const AreaLight& light = context.world.area_lights[hit.triangle];
    const float cosine = -ray.d.dot(light.normal);
    if (cosine <= 0) return;
    radiance += weight * light.radiance *
                hit_weight(pdf == kInfinity ? 0 : context.lights.pdf_area_light(hit, cosine));
  }

  void add_emission(const Surface& surface, const Hit& hit) {
    if (!surface.front && !surface.part->material->double_sided) return;
    const float cosine = std::abs(ray.d.dot(surface.ng));
    const float competing = pdf == kInfinity || cosine == 0 ? 0 : context.lights.pdf_triangle(hit, cosine);
    radiance +=
        weight * eval_emission(context.scene, *surface.part->material, surface.uvs) * hit_weight(competing);
  }

  /// Light that reaches the surface straight from a sampled point of a sampled light.
  void add_direct_light(const Surface& surface, const Bsdf& bsdf) {
    const std::optional<LightSample> light = context.lights.sample(surface.p, sampler);
    if (!light) return;
    if (!light->delta && settings.strategy == Strategy::bsdf) return;
    const BsdfValue value = bsdf.eval(light->wi);
    if (is_black(value.f_cos)) return;
    const float share =
        light->delta || settings.strategy == Strategy::light ? 1 : power_heuristic(light->pdf, value.pdf);
    const Rgb contribution = weight * value.f_cos * light->radiance * (share / light->pdf);
    if (is_black(contribution)) return;
    const Vec3f origin = ray_origin(surface, light->wi);
    const Ray shadow =
        light->at_infinity ? Ray{origin, light->wi} : Ray{origin, light->target - origin, kShadowEnd};
    ++counts.shadow;
    if (!context.accel.occluded(shadow, sampler.hash())) radiance += contribution;
  }

  /// Goes on in a direction sampled from the BSDF; false where the path ends.
  bool scatter(const Surface& surface, const Bsdf& bsdf) {
    const float choice = bsdf.has_choice() ? sampler.next1() : 0;
    const std::optional<BsdfSample> sample = bsdf.sample(choice, sampler.next2());
    if (!sample) return false;
    weight *= sample->weight;
    pdf = sample->pdf;
    ray = {ray_origin(surface, sample->wi), sample->wi};
    return true;
  }

  /// Russian roulette by what the path still carries: the survivors' weights make up for the others.
  bool survive() {
    const float survival = std::min(1.0f, max_component(weight));
    if (!(survival > 0)) return false;
    if (survival < 1) {
      if (sampler.next_independent() >= survival) return false;
      weight *= 1 / survival;
    }
    return true;
  }
};

}  // namespace

Rgb PathIntegrator::radiance(const TraceContext& context, const Ray& camera_ray, Sampler& sampler,
                             RayCounts& counts, Features* features) const {
  Path path{context, settings_, sampler, counts, camera_ray};
  for (int depth = 0;; ++depth) {
    Hit hit;
    // A ray that leaves the scene, or ends at a light without a surface, brings what it sees there.
    if (depth > 0) ++counts.scattered;
    if (!context.accel.intersect(path.ray, sampler.hash(), hit, depth == 0)) {
      path.add_environment();
      break;
    }
    if (hit.placement == Hit::kAreaLightHit) {
      if (features && depth == 0) *features = area_light_features(context, hit);
      path.add_area_light(hit);
      break;
    }

    const Surface surface = make_surface(context.scene, context.world, hit, path.ray.d);
    if (features && depth == 0) *features = surface_features(context, surface, hit);
    if (surface.part->material->unlit) {
      path.radiance += path.weight * eval_base_color(context.scene, surface);
      break;
    }
    if (surface.part->emissive) path.add_emission(surface, hit);
    if (depth == settings_.max_depth) break;

    // Scatter: light sampled directly, then a direction to go on.
    const Bsdf bsdf = make_bsdf(context.scene, surface);
    if (!context.lights.empty()) path.add_direct_light(surface, bsdf);
    if (!path.scatter(surface, bsdf) || !path.survive()) break;
  }
  return path.radiance;
}

}  // namespace parian
