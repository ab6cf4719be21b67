#include "renderer/session/build_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "renderer/base/memory.h"

namespace parian {
namespace {

// Rays for each triangle below which the quick build pays: it saves a third of the time of building, 0.1 us
// for a triangle, and a ray takes a quarter longer, 0.6 us; and rays for each copied triangle above which
// copies pay, which take 0.35 us to build and save a tenth of a ray (docs/large.md).
constexpr double kFastUpTo = 0.2, kBestFrom = 10;

// Of a camera path, on average, where the samples are counted.
constexpr double kRaysPerPath = 4;
// Where the time is given.
constexpr double kRaysPerThreadSecond = 1e6;

double expected_rays(const RenderSettings& s) {
  double rays = 1e18;  // until the noise is low: long
  if (s.spp != kNoLimit) rays = kRaysPerPath * s.spp * s.width * s.height;
  if (s.seconds > 0) rays = std::min(rays, kRaysPerThreadSecond * thread_count() * s.seconds);
  return rays;
}

BuildQuality worthwhile_quality(const Scene& scene, const World& world, double rays) {
  double triangles = 0;
  for (const Part& part : world.parts) triangles += double(part.primitive->triangles.size());
  if (rays < kFastUpTo * triangles) return BuildQuality::fast;
  const double copied = copied_triangles(scene, world);
  return copied > 0 && rays > kBestFrom * copied ? BuildQuality::best : BuildQuality::balanced;
}

LightTableBytes estimate_lights(const World& world, LightChoice choice) {
  std::size_t lights = world.area_lights.size() + world.punctual_lights.size(), slots = 0;
  for (const PlacedSolid& solid : world.solids) lights += world.solid_parts[solid.part].emissive;
  for (const Placement& p : world.placements)
    for (std::uint32_t i = p.first_part; i < p.first_part + p.part_count; ++i) {
      if (!world.parts[i].emissive) continue;
      lights += world.parts[i].primitive->triangles.size();
      ++slots;
    }
  return light_table_bytes(lights, choice, std::max<std::size_t>(1, slots));
}

void estimate(BuildPlan& plan, const Scene& scene, const World& world, std::size_t at_end) {
  plan.accel_memory = estimate_memory(scene, world, plan.accel);
  // One after the other: the BVH, the lights, the film; and the picture, when all else is gone.
  const std::size_t held = plan.accel_memory.held;
  const std::size_t more =
      std::max({plan.accel_memory.peak, held + plan.lights.peak, held + plan.lights.held + plan.film});
  plan.peak = std::max({peak_memory(), resident_memory() + more, at_end + plan.film});
}

}  // namespace

std::string BuildPlan::describe() const {
  constexpr const char* kNames[] = {"fast", "balanced", "best"};
  return fmt::format(
      "about {} at the peak: {} acceleration structure ({}{}, {} while it is built), {} lights, {} picture",
      format_bytes(double(peak)), format_bytes(double(accel_memory.held)), kNames[std::size_t(accel.quality)],
      accel.compact ? ", compact" : "", format_bytes(double(accel_memory.peak)),
      format_bytes(double(lights.held)), format_bytes(double(film)));
}

BuildPlan plan_build(const Scene& scene, const World& world, const RenderSettings& settings) {
  BuildPlan plan;
  plan.accel = settings.accel;
  plan.lights = estimate_lights(world, settings.light_choice);
  plan.film = Film::bytes(settings.width, settings.height, settings.layers);
  plan.accel.quality =
      settings.build ? *settings.build : worthwhile_quality(scene, world, expected_rays(settings));
  estimate(plan, scene, world, settings.memory_at_end);
  const auto fits = [&] { return plan.peak <= memory_limit(); };
  if (!fits() && !settings.build && plan.accel.quality != BuildQuality::balanced) {
    plan.accel.quality = BuildQuality::balanced;
    estimate(plan, scene, world, settings.memory_at_end);
  }
  if (!fits()) {
    plan.accel.compact = true;
    estimate(plan, scene, world, settings.memory_at_end);
  }
  if (!fits())
    throw std::runtime_error(fmt::format("not enough memory: the render takes {}; the limit is {}",
                                         plan.describe(), format_bytes(double(memory_limit()))));
  return plan;
}

}  // namespace parian
