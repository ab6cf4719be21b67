/// The render loop of a session: passes over tiles.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/session/adaptive.h"
#include "renderer/session/camera_rays.h"
#include "renderer/session/seconds.h"
#include "renderer/session/session.h"

namespace parian {
namespace {

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

bool Session::out_of_time() const {
  return settings_.seconds > 0 && seconds_since(started_) >= settings_.seconds;
}

bool Session::interrupted() const {
  if (cancel_.load(std::memory_order_relaxed)) return true;
  if (!edited_.load(std::memory_order_relaxed)) return false;
  return !first_pass_ || seconds_since(pass_started_) > 2 * settings_.first_frame;
}

/// The thread: applies edits, and renders between them.
void Session::run() {
  do {
    if (edited_ && !apply_edit()) continue;
    if (!render_coarse()) continue;
    render();
  } while (!is_finished());
}

/// Whether nothing is left to do; then nothing is asked of this thread any more.
bool Session::is_finished() {
  const std::lock_guard lock(edit_mutex_);
  if (edited_ && !cancel_) return false;
  running_ = false;
  return true;
}

/// Where the full resolution takes too long: one sample of each pixel of a smaller picture. False if it was
/// interrupted.
bool Session::render_coarse() {
  first_pass_ = settings_.first_frame > 0 && finished_samples_ == 0;
  if (!first_pass_) return true;
  const double budget = std::max(settings_.first_frame / 4, settings_.first_frame - stats_.edit_seconds);
  const double pixels = double(full_.film->width()) * full_.film->height();
  const auto is_quick = [&](int scale) { return pixels / (scale * scale) * sample_seconds_ <= budget; };
  int scale = 1;
  for (const int next : {2, 3, 4, 6, 8})
    if (!is_quick(scale)) scale = next;
  if (scale == 1) return true;
  const auto reduced = [&](int size) { return (size + scale - 1) / scale; };
  const Target coarse =
      make_target(reduced(full_.film->width()), reduced(full_.film->height()), {.variance = false});
  coarse.film->set_plan(std::vector(coarse.film->plan().size(), 1u));
  const bool complete = render_pass(coarse);
  first_pass_ = false;
  if (complete) show(coarse.film);
  return !interrupted();
}

void Session::render() {
  // A pass that was interrupted is ended first: the next depends on its result.
  for (bool more = full_.film->is_behind_plan() || plan_pass(); more; more = plan_pass()) {
    const bool complete = render_pass(full_);
    first_pass_ = false;
    if (complete) {
      finished_samples_ = *std::ranges::min_element(full_.film->plan());
      show(full_.film);
    }
    if (!complete || interrupted() || out_of_time()) return;
    if (settings_.accel.editable) refine();
  }
}

/// Lets others see a film that has a complete frame.
void Session::show(std::shared_ptr<Film> film) {
  if (shown_ != film) {
    const std::unique_lock lock(scene_mutex_);
    shown_ = std::move(film);
  }
  ++frames_;
}

/// Plans the next pass; false where the picture is finished.
bool Session::plan_pass() {
  const std::uint32_t done = finished_samples_;
  const std::vector<std::uint32_t>& planned = full_.film->plan();  // what all blocks have now
  const double samples = std::accumulate(planned.begin(), planned.end(), 0.0);
  done_ = std::min(1.0, samples / double(planned.size()) / settings_.spp);
  if (settings_.noise > 0 && done >= kMinAdaptiveSamples) {
    const BlockNoise noise = full_.film->block_noise();
    // The error falls with the square root of the work.
    done_ = std::clamp(std::pow(settings_.noise / picture_noise(noise).bound, 2), double(done_), 1.0);
    std::vector<std::uint32_t> plan = plan_adaptive_pass(noise, settings_.noise, settings_.spp);
    if (plan.empty()) return false;
    full_.film->set_plan(std::move(plan));
    return true;
  }
  if (done >= settings_.spp) return false;
  // Passes of 1, 1, 2, 4, 8, 16, 16 ... samples: the first pictures come at once, and later passes are long
  // enough that their ends, where threads wait for each other, do not count. Who watches sees them more
  // often.
  constexpr double kWatchedSeconds = 0.5;
  const double pass = sample_seconds_ * full_.film->width() * full_.film->height();
  const bool watched = settings_.first_frame > 0;
  const auto most = std::uint32_t(watched ? std::clamp(kWatchedSeconds / pass, 1.0, 16.0) : 16.0);
  const std::uint32_t step = std::min(std::clamp(done, 1u, most), settings_.spp - done);
  full_.film->set_plan(std::vector(full_.film->plan().size(), done + step));
  return true;
}

/// False if it was interrupted before its end.
bool Session::render_pass(const Target& target) {
  pass_started_ = Clock::now();
  pass_samples_ = 0;
  merged_tiles_ = 0;
  tile_loop_.run(target.tiles.size(), [&](std::size_t i) { render_tile(target, target.tiles[i]); });
  learn_cost();
  return merged_tiles_ == target.tiles.size();
}

void Session::learn_cost() {
  constexpr std::uint64_t kLeast = 1000;  // fewer say little, but where they took long
  const std::uint64_t samples = pass_samples_;
  const double seconds = seconds_since(pass_started_);
  if (samples >= kLeast || (samples > 0 && seconds > settings_.first_frame))
    sample_seconds_ = seconds / double(samples);
}

void Session::render_tile(const Target& target, const Tile& area) {
  if (out_of_time() || interrupted()) return;
  Film& film = *target.film;
  FilmTile tile = film.checkout(area);
  RayCounts counts;
  auto rays = tile.rays.begin();
  for (int y = area.y0; y < area.y1; y += kBlock)
    for (int x = area.x0; x < area.x1; x += kBlock, ++rays) {
      const std::size_t block = std::size_t(y / kBlock) * film.block_columns() + x / kBlock;
      const std::uint64_t before = counts.total();
      render_block(target, tile, {x, y, std::min(x + kBlock, area.x1), std::min(y + kBlock, area.y1)},
                   film.plan()[block], counts);
      *rays += counts.total() - before;
      if (interrupted()) {  // the tile is given up
        pass_samples_ += counts.camera;
        return;
      }
    }
  film.merge(tile);
  pass_samples_ += counts.camera;
  ++merged_tiles_;
  const std::lock_guard lock(stats_mutex_);
  stats_.rays += counts;
}

void Session::render_block(const Target& target, FilmTile& tile, const Tile& block, std::uint32_t goal,
                           RayCounts& counts) const {
  const TraceContext context{*scene_, *world_, *accel_, *lights_, camera_media_};
  const bool features_wanted = !tile.features.empty();
  const auto index = [&](int x, int y) {
    return std::size_t(y - tile.area.y0) * (tile.area.x1 - tile.area.x0) + (x - tile.area.x0);
  };
  std::array<std::uint32_t, RayPacket::kSize> keys;
  std::size_t count = 0;
  for (int y = block.y0; y < block.y1; ++y)
    for (int x = block.x0; x < block.x1; ++x) keys[count++] = Sampler::pixel_key(settings_.seed, x, y);
  for (std::uint32_t sample = tile.pixels[index(block.x0, block.y0)].samples; sample < goal; ++sample) {
    if (interrupted() || out_of_time()) return;
    // The camera rays of one sample of each pixel, traced together.
    std::array<CameraPath, RayPacket::kSize> paths;
    for (std::size_t i = 0; i < count; ++i) {
      paths[i].sampler = Sampler(settings_.sampler, keys[i], sample);
      paths[i].radiance = Rgb(0, 0, 0);
      if (features_wanted) paths[i].features = {};
    }
    RayPacket rays;
    generate_rays(target.view, filter_, block, {paths.data(), count}, rays);
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

}  // namespace parian
