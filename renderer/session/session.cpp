#include "renderer/session/session.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/base/parallel.h"
#include "renderer/session/adaptive.h"
#include "renderer/session/build_plan.h"
#include "renderer/session/camera_rays.h"
#include "renderer/session/media.h"

namespace parian {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Camera rays are traced in packets of one sample of each pixel of a block, so the packets are the same
// however a render is cut.
static_assert(kBlock * kBlock == RayPacket::kSize);

bool is_valid(const Rgb& c) { return is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0; }

void add_features(FeatureSums& sums, const Features& f) {
  for (int k = 0; k < 3; ++k) {
    sums.albedo[k] += f.albedo[k];
    sums.normal[k] += f.normal[k];
  }
  sums.depth += f.depth;
  sums.walked += f.walked;
  sums.diffused += f.diffused;
}

}  // namespace

double process_cpu_seconds() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Session::Session(std::shared_ptr<const Scene> scene, const RenderSettings& settings,
                 std::unique_ptr<Integrator> integrator)
    : scene_(std::move(scene)),
      settings_(settings),
      integrator_(std::move(integrator)),
      filter_(settings.filter),
      tiles_(make_tiles(settings.width, settings.height, settings.tiling, thread_count())),
      tile_loop_(settings.partitioner) {
  const Clock::time_point start = Clock::now();
  world_ = std::make_unique<World>(make_world(*scene_));
  integrator_->prepare(*world_);
  const BuildPlan plan = plan_build(*scene_, *world_, settings_);
  settings_.accel = plan.accel;
  accel_ = std::make_unique<Accel>(*scene_, *world_, settings_.accel);
  build_lights();
  film_ = std::make_unique<Film>(settings.width, settings.height, settings.layers);  // last: it needs no peak
  view_ = make_camera_view(*scene_, world_->cameras.at(settings_.camera), settings_.width, settings_.height);
  camera_media_ = find_media(*world_, *accel_, view_.to_world.origin);
  for (const Part& part : world_->parts) stats_.triangles += part.primitive->triangles.size();
  stats_.solids = world_->solids.size();
  stats_.predicted_peak = plan.peak;
  stats_.quality = plan.accel.quality;
  stats_.compact = plan.accel.compact;
  stats_.build_seconds = seconds_since(start);
}

Session::~Session() { cancel(); }

void Session::build_lights() {
  const Clock::time_point start = Clock::now();
  lights_ = std::make_unique<LightTable>(*scene_, *world_, settings_.light_choice);
  ++stats_.light_builds;
  stats_.light_bytes = lights_->bytes();
  stats_.light_build_seconds = seconds_since(start);
}

void Session::start() {
  cancel();
  cancel_ = false;
  running_ = true;
  failure_ = nullptr;
  started_ = Clock::now();
  finished_samples_ = film_->min_samples();
  done_ = 0;
  thread_ = std::thread([this] {
    const double cpu = process_cpu_seconds();
    try {
      render();
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(stats_mutex_);
    stats_.render_seconds += seconds_since(started_);
    stats_.render_cpu_seconds += process_cpu_seconds() - cpu;
    running_ = false;
  });
}

void Session::cancel() {
  cancel_ = true;
  if (thread_.joinable()) thread_.join();
}

void Session::wait() {
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

Progress Session::progress() const {
  const std::lock_guard lock(stats_mutex_);
  Progress progress{finished_samples_, settings_.spp,
                    running_ ? seconds_since(started_) : stats_.render_seconds, 0, running_};
  progress.done = settings_.seconds > 0 ? std::clamp(progress.seconds / settings_.seconds, double(done_), 1.0)
                                        : double(done_);
  return progress;
}

SessionStats Session::stats() const {
  const std::lock_guard lock(stats_mutex_);
  SessionStats stats = stats_;
  stats.accel_bytes = accel_->bytes();
  stats.builds = accel_->builds();
  return stats;
}

bool Session::out_of_time() const {
  return settings_.seconds > 0 && seconds_since(started_) >= settings_.seconds;
}

void Session::render() {
  // A pass that was interrupted is ended first: the next depends on its result.
  for (bool more = film_->is_behind_plan() || plan_pass(); more; more = plan_pass()) {
    render_pass();
    if (cancel_ || out_of_time()) return;
    finished_samples_ = *std::ranges::min_element(film_->plan());
  }
}

/// Plans the next pass; false where the picture is finished.
bool Session::plan_pass() {
  const std::uint32_t done = finished_samples_;
  const std::vector<std::uint32_t>& planned = film_->plan();  // what all blocks have now
  const double samples = std::accumulate(planned.begin(), planned.end(), 0.0);
  done_ = std::min(1.0, samples / double(planned.size()) / settings_.spp);
  if (settings_.noise > 0 && done >= kMinAdaptiveSamples) {
    const BlockNoise noise = film_->block_noise();
    // The error falls with the square root of the work.
    done_ = std::clamp(std::pow(settings_.noise / picture_noise(noise).bound, 2), double(done_), 1.0);
    std::vector<std::uint32_t> plan = plan_adaptive_pass(noise, settings_.noise, settings_.spp);
    if (plan.empty()) return false;
    film_->set_plan(std::move(plan));
    return true;
  }
  if (done >= settings_.spp) return false;
  // Passes of 1, 1, 2, 4, 8, 16, 16 ... samples: the first pictures come at once, and later passes are long
  // enough that their ends, where threads wait for each other, do not count.
  const std::uint32_t step = std::min(std::clamp(done, 1u, 16u), settings_.spp - done);
  film_->set_plan(std::vector(film_->plan().size(), done + step));
  return true;
}

void Session::render_pass() {
  tile_loop_.run(tiles_.size(), [&](std::size_t i) { render_tile(tiles_[i]); });
}

void Session::render_tile(const Tile& area) {
  if (out_of_time()) return;
  FilmTile tile = film_->checkout(area);
  RayCounts counts;
  auto rays = tile.rays.begin();
  for (int y = area.y0; y < area.y1; y += kBlock)
    for (int x = area.x0; x < area.x1; x += kBlock, ++rays) {
      const std::size_t block = std::size_t(y / kBlock) * film_->block_columns() + x / kBlock;
      const std::uint64_t before = counts.total();
      render_block(tile, {x, y, std::min(x + kBlock, area.x1), std::min(y + kBlock, area.y1)},
                   film_->plan()[block], counts);
      *rays += counts.total() - before;
      if (cancel_.load(std::memory_order_relaxed)) return;  // the tile is given up
    }
  film_->merge(tile);
  const std::lock_guard lock(stats_mutex_);
  stats_.rays += counts;
}

void Session::render_block(FilmTile& tile, const Tile& block, std::uint32_t target, RayCounts& counts) const {
  const TraceContext context{*scene_, *world_, *accel_, *lights_, camera_media_};
  const bool features_wanted = !tile.features.empty();
  const auto index = [&](int x, int y) {
    return std::size_t(y - tile.area.y0) * (tile.area.x1 - tile.area.x0) + (x - tile.area.x0);
  };
  std::array<std::uint32_t, RayPacket::kSize> keys;
  std::size_t count = 0;
  for (int y = block.y0; y < block.y1; ++y)
    for (int x = block.x0; x < block.x1; ++x) keys[count++] = Sampler::pixel_key(settings_.seed, x, y);
  for (std::uint32_t sample = tile.pixels[index(block.x0, block.y0)].samples; sample < target; ++sample) {
    if (cancel_.load(std::memory_order_relaxed) || out_of_time()) return;
    // The camera rays of one sample of each pixel, traced together.
    std::array<CameraPath, RayPacket::kSize> paths;
    for (std::size_t i = 0; i < count; ++i) {
      paths[i].sampler = Sampler(settings_.sampler, keys[i], sample);
      paths[i].radiance = Rgb(0, 0, 0);
      if (features_wanted) paths[i].features = {};
    }
    RayPacket rays;
    generate_rays(view_, filter_, block, {paths.data(), count}, rays);
    std::array<Hit, RayPacket::kSize> hits;
    accel_->intersect(rays, hits);
    for (std::size_t i = 0; i < count; ++i) paths[i].hit = hits[i];
    counts.camera += count;

    integrator_->estimate(context, {paths.data(), count}, counts, features_wanted);

    const CameraPath* path = paths.data();
    for (int y = block.y0; y < block.y1; ++y)
      for (int x = block.x0; x < block.x1; ++x, ++path) {
        PixelSums& sums = tile.pixels[index(x, y)];
        if (features_wanted) {
          if (sums.samples == 0) sums.object = path->features.object;
          add_features(tile.features[index(x, y)], path->features);
        }
        const bool valid = is_valid(path->radiance);
        counts.dropped += !valid;
        sums.add(valid ? path->radiance : Rgb(0, 0, 0));
      }
  }
}

void Session::update(std::shared_ptr<const Scene> scene, unsigned changed) {
  const bool was_running = running_;
  cancel();
  const std::vector<CameraPlacement> cameras = place_cameras(*scene);
  view_ = make_camera_view(*scene, cameras.at(settings_.camera), settings_.width, settings_.height);
  // A camera moves nothing that rays meet: the scene traced so far stays.
  if (changed & ~unsigned(kChangedCamera)) retrace(std::move(scene), changed);
  camera_media_ = find_media(*world_, *accel_, view_.to_world.origin);
  film_->clear();
  finished_samples_ = 0;
  if (was_running) start();
}

void Session::retrace(std::shared_ptr<const Scene> scene, unsigned changed) {
  auto world =
      std::make_unique<World>(make_world(*scene, changed & kChangedGeometry ? nullptr : world_.get()));
  // Whether a solid is in the geometry of the round spheres.
  const auto same_kind = [](const PlacedSolid& a, const PlacedSolid& b) {
    return a.part == b.part && a.is_round() == b.is_round();
  };
  // Alpha decides which geometries are filtered, and a scale of zero removes a placement.
  const auto same_structure = [&] {
    return std::ranges::equal(world->parts, world_->parts, {}, &Part::alpha, &Part::alpha) &&
           std::ranges::equal(world->solid_parts, world_->solid_parts, {}, &Part::alpha, &Part::alpha) &&
           std::ranges::equal(world->solids, world_->solids, same_kind) &&
           std::ranges::equal(world->placements, world_->placements, {}, &Placement::mesh,
                              &Placement::mesh) &&
           world->area_lights.size() == world_->area_lights.size() &&
           world->media.empty() == world_->media.empty();
  };
  if ((changed & kChangedGeometry) || !same_structure()) {
    accel_.reset();  // its memory before the new one's
    accel_ = std::make_unique<Accel>(*scene, *world, settings_.accel);
  } else if (changed & (kChangedTransforms | kChangedLights)) {
    accel_->update_transforms(*scene, *world);
  } else {
    accel_->rebind(*scene, *world);
  }
  scene_ = std::move(scene);
  world_ = std::move(world);
  integrator_->prepare(*world_);
  build_lights();
}

}  // namespace parian
