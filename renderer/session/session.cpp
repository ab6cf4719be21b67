#include "renderer/session/session.h"

#include <sys/resource.h>

#include <algorithm>

#include "renderer/base/parallel.h"

namespace parian {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool is_valid(const Rgb& c) { return is_finite(c) && c.x >= 0 && c.y >= 0 && c.z >= 0; }

void add_features(FeatureSums& sums, const Features& f) {
  for (int k = 0; k < 3; ++k) {
    sums.albedo[k] += f.albedo[k];
    sums.normal[k] += f.normal[k];
  }
  sums.depth += f.depth;
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
      film_(settings.width, settings.height, settings.layers) {
  const Clock::time_point start = Clock::now();
  world_ = std::make_unique<World>(make_world(*scene_));
  accel_ = std::make_unique<Accel>(*scene_, *world_, settings_.accel);
  build_lights();
  view_ = make_camera_view(*scene_, world_->cameras.at(settings_.camera), settings_.width, settings_.height);
  for (const Part& part : world_->parts) stats_.triangles += part.primitive->triangles.size();
  stats_.build_seconds = seconds_since(start);
}

Session::~Session() { cancel(); }

void Session::build_lights() {
  lights_ = std::make_unique<LightTable>(*scene_, *world_);
  ++stats_.light_builds;
}

void Session::start() {
  cancel();
  cancel_ = false;
  running_ = true;
  failure_ = nullptr;
  started_ = Clock::now();
  finished_samples_ = film_.min_samples();
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
  return {finished_samples_, settings_.spp, running_ ? seconds_since(started_) : stats_.render_seconds,
          running_};
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

/// Passes of 1, 1, 2, 4, 8, 16, 16 ... samples: the first pictures come at once, and later passes are long
/// enough that their ends, where threads wait for each other, do not count.
void Session::render() {
  const std::uint32_t total = settings_.seconds > 0 ? 0xffffffffu : settings_.spp;
  for (std::uint32_t done = finished_samples_; done < total && !cancel_ && !out_of_time();) {
    const std::uint32_t step = std::clamp(done, 1u, 16u);
    done = total - done > step ? done + step : total;
    render_pass(done);
    if (!cancel_ && !out_of_time()) finished_samples_ = done;
  }
}

void Session::render_pass(std::uint32_t target) {
  const int size = settings_.tile_size;
  const int columns = (settings_.width + size - 1) / size, rows = (settings_.height + size - 1) / size;
  parallel_for(std::size_t(columns) * rows, 1, [&](std::size_t i) {
    const int x = int(i % columns) * size, y = int(i / columns) * size;
    render_tile({x, y, std::min(x + size, settings_.width), std::min(y + size, settings_.height)}, target);
  });
}

void Session::render_tile(const Tile& area, std::uint32_t target) {
  if (cancel_ || out_of_time()) return;
  const TraceContext context{*scene_, *world_, *accel_, *lights_};
  FilmTile tile = film_.checkout(area);
  RayCounts counts;
  Features features;
  std::size_t i = 0;
  for (int y = area.y0; y < area.y1; ++y)
    for (int x = area.x0; x < area.x1; ++x, ++i) {
      if (cancel_.load(std::memory_order_relaxed)) return;
      PixelSums& sums = tile.pixels[i];
      while (sums.samples < target) {
        Sampler sampler(settings_.sampler, settings_.seed, x, y, sums.samples);
        const Vec2f film = Vec2f(float(x) + 0.5f, float(y) + 0.5f) + filter_.sample(sampler.next2());
        const Ray ray = generate_ray(view_, film, view_.lens_radius > 0 ? sampler.next2() : Vec2f(0));
        ++counts.camera;
        if (!tile.features.empty()) features = {};
        Rgb radiance =
            integrator_->radiance(context, ray, sampler, counts, tile.features.empty() ? nullptr : &features);
        if (!is_valid(radiance)) {
          radiance = Rgb(0, 0, 0);
          ++counts.dropped;
        }
        if (!tile.features.empty()) {
          if (sums.samples == 0) sums.object = features.object;
          add_features(tile.features[i], features);
        }
        sums.add(radiance);
      }
    }
  film_.merge(tile);
  const std::lock_guard lock(stats_mutex_);
  stats_.rays += counts;
}

void Session::update(std::shared_ptr<const Scene> scene, unsigned changed) {
  const bool was_running = running_;
  cancel();
  const std::vector<CameraPlacement> cameras = place_cameras(*scene);
  view_ = make_camera_view(*scene, cameras.at(settings_.camera), settings_.width, settings_.height);
  // A camera moves nothing that rays meet: the scene traced so far stays.
  if (changed & ~unsigned(kChangedCamera)) retrace(std::move(scene), changed);
  film_.clear();
  finished_samples_ = 0;
  if (was_running) start();
}

void Session::retrace(std::shared_ptr<const Scene> scene, unsigned changed) {
  auto world =
      std::make_unique<World>(make_world(*scene, changed & kChangedGeometry ? nullptr : world_.get()));
  // Alpha decides which geometries are filtered, and a scale of zero removes a placement.
  const auto same_structure = [&] {
    return std::ranges::equal(world->parts, world_->parts, {}, &Part::alpha, &Part::alpha) &&
           std::ranges::equal(world->placements, world_->placements, {}, &Placement::mesh,
                              &Placement::mesh) &&
           world->area_lights.size() == world_->area_lights.size();
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
  build_lights();
}

}  // namespace parian
