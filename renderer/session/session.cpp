/// A session from outside: made, started, cancelled, looked at.
#include "renderer/session/session.h"

#include <sys/resource.h>

#include <algorithm>

#include "renderer/base/parallel.h"
#include "renderer/session/build_plan.h"
#include "renderer/session/media.h"
#include "renderer/session/seconds.h"

namespace parian {

double process_cpu_seconds() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Session::Session(std::shared_ptr<const Scene> scene, const RenderSettings& settings,
                 std::unique_ptr<Integrator> integrator)
    : settings_(settings),
      integrator_(std::move(integrator)),
      filter_(settings.filter),
      tile_loop_(settings.partitioner),
      scene_(std::move(scene)),
      camera_scene_(scene_) {
  const Clock::time_point start = Clock::now();
  world_ = std::make_unique<World>(make_world(*scene_));
  integrator_->prepare(*world_);
  const BuildPlan plan = plan_build(*scene_, *world_, settings_);
  settings_.accel = plan.accel;
  accel_ = std::make_shared<Accel>(*scene_, *world_, settings_.accel);
  build_lights();
  camera_ = world_->cameras.at(settings_.camera);
  full_ = make_target(settings_.width, settings_.height, settings_.layers);  // last: it needs no peak
  shown_ = full_.film;
  camera_media_ = find_media(*world_, *accel_, full_.view.to_world.origin);
  for (const Part& part : world_->parts) stats_.triangles += part.primitive->triangles.size();
  stats_.solids = world_->solids.size();
  stats_.predicted_peak = plan.peak;
  stats_.quality = plan.accel.quality;
  stats_.compact = plan.accel.compact;
  stats_.build_seconds = seconds_since(start);
}

Session::~Session() {
  if (refinement_) refinement_->cancelled = true;
  cancel();
  if (refinement_) refinement_->thread.join();
}

Session::Target Session::make_target(int width, int height, const FilmLayers& layers) const {
  return {std::make_shared<Film>(width, height, layers),
          make_camera_view(*camera_scene_, camera_, width, height),
          make_tiles(width, height, settings_.tiling, thread_count())};
}

void Session::start() {
  cancel();
  cancel_ = false;
  running_ = true;
  failure_ = nullptr;
  started_ = Clock::now();
  if (!edited_) finished_samples_ = full_.film->min_samples();
  done_ = 0;
  thread_ = std::thread([this] {
    const double cpu = process_cpu_seconds();
    try {
      run();
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
  const std::shared_lock scene_lock(scene_mutex_);
  const std::lock_guard lock(stats_mutex_);
  SessionStats stats = stats_;
  stats.accel_bytes = accel_->bytes();
  stats.builds = accel_->builds();
  return stats;
}

}  // namespace parian
