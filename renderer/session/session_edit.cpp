/// How a session follows edits.
#include <algorithm>

#include "renderer/session/media.h"
#include "renderer/session/seconds.h"
#include "renderer/session/session.h"

namespace parian {

void Session::update(std::shared_ptr<const Scene> scene, unsigned changed) {
  request({std::move(scene), changed, 0, 0});
}

void Session::resize(int width, int height) { request({nullptr, 0, width, height}); }

void Session::request(Edit edit) {
  {
    const std::lock_guard lock(edit_mutex_);
    if (edit.scene) edit_.scene = std::move(edit.scene);
    edit_.changed |= edit.changed;
    if (edit.width > 0) edit_.width = edit.width, edit_.height = edit.height;
    edited_ = true;
    if (running_ && !cancel_) return;
  }
  cancel();
  cancel_ = false;
  apply_edit();
}

/// Applies what waits. False if it was cancelled, and waits on.
bool Session::apply_edit() {
  Edit edit;
  {
    const std::lock_guard lock(edit_mutex_);
    edit = std::exchange(edit_, {});
    edited_ = false;
  }
  const Clock::time_point start = Clock::now();
  finished_samples_ = 0;
  try {
    apply(edit);
  } catch (const BuildCancelled&) {
    const std::lock_guard lock(edit_mutex_);
    if (!edit_.scene) edit_.scene = std::move(edit.scene);
    edit_.changed |= edit.changed;
    if (edit_.width == 0) edit_.width = edit.width, edit_.height = edit.height;
    edited_ = true;
    return false;
  }
  const std::lock_guard lock(stats_mutex_);
  stats_.edit_seconds = seconds_since(start);
  return true;
}

void Session::apply(const Edit& edit) {
  // A camera moves nothing that rays meet: the scene traced so far stays.
  const bool traced = edit.scene && (edit.changed & ~unsigned(kChangedCamera));
  if (traced) retrace(edit.scene, edit.changed);
  CameraPlacement camera = camera_;
  if (edit.scene) camera = (traced ? world_->cameras : place_cameras(*edit.scene)).at(settings_.camera);
  const int width = edit.width > 0 ? edit.width : full_.film->width();
  const int height = edit.width > 0 ? edit.height : full_.film->height();

  const std::unique_lock lock(scene_mutex_);
  camera_ = camera;
  if (edit.scene) camera_scene_ = edit.scene;
  if (width != full_.film->width() || height != full_.film->height())
    full_ = make_target(width, height, settings_.layers);
  else
    start_film_again();
  full_.view = make_camera_view(*camera_scene_, camera_, width, height);
  camera_media_ = find_media(*world_, *accel_, full_.view.to_world.origin);
}

/// With a film that nobody is shown: what was before stays to be seen until there is another complete frame.
void Session::start_film_again() {
  if (shown_ == full_.film && settings_.first_frame > 0) {
    std::shared_ptr<Film>& film = full_.film;
    if (!spare_ || spare_.use_count() > 1 || spare_->width() != film->width() ||
        spare_->height() != film->height())
      spare_ = std::make_shared<Film>(film->width(), film->height(), film->layers());
    std::swap(spare_, film);
  }
  full_.film->clear();
}

/// Whether a world differs from that rendered in nothing but where things are.
bool Session::is_same_structure(const World& world) const {
  const bool editable = settings_.accel.editable;
  // Whether a solid is in the geometry of the round spheres.
  const auto same_kind = [](const PlacedSolid& a, const PlacedSolid& b) {
    return a.part == b.part && a.is_round() == b.is_round();
  };
  // Alpha decides which geometries are filtered, and a scale of zero removes a placement.
  return (editable || std::ranges::equal(world.parts, world_->parts, {}, &Part::alpha, &Part::alpha)) &&
         std::ranges::equal(world.solid_parts, world_->solid_parts, {}, &Part::alpha, &Part::alpha) &&
         std::ranges::equal(world.solids, world_->solids, same_kind) &&
         std::ranges::equal(world.placements, world_->placements, {}, &Placement::mesh, &Placement::mesh) &&
         world.area_lights.size() == world_->area_lights.size() &&
         (editable || world.media.empty() == world_->media.empty());
}

void Session::retrace(std::shared_ptr<const Scene> scene, unsigned changed) {
  auto world = std::make_unique<World>(make_world(*scene, world_.get()));
  const bool rebuild = (changed & kChangedGeometry) || !is_same_structure(*world);
  // Of a scene to be edited the one before serves questions meanwhile, and is there still if this is
  // cancelled.
  std::shared_ptr<Accel> accel;
  if (rebuild && settings_.accel.editable) {
    accel = std::make_shared<Accel>(*scene, *world, settings_.accel, accel_.get(), &cancel_);
    refined_all_ = false;
  }
  const std::unique_lock lock(scene_mutex_);
  if (accel) {
    accel_ = std::move(accel);
  } else if (rebuild) {
    accel_.reset();  // its memory before the new one's
    accel_ = std::make_shared<Accel>(*scene, *world, settings_.accel);
  } else if (changed & (kChangedTransforms | kChangedLights)) {
    accel_->update_transforms(*scene, *world);
  } else {
    accel_->rebind(*scene, *world);
  }
  integrator_->prepare(*world);
  const bool same_lights = lights_->rebind(*scene, *world);
  const std::shared_ptr<const Scene> old_scene = std::exchange(scene_, std::move(scene));
  const std::unique_ptr<World> old_world = std::exchange(world_, std::move(world));
  if (!same_lights) build_lights();
}

void Session::build_lights() {
  const Clock::time_point start = Clock::now();
  lights_ = std::make_unique<LightTable>(*scene_, *world_, settings_.light_choice);
  const std::lock_guard lock(stats_mutex_);
  ++stats_.light_builds;
  stats_.light_bytes = lights_->bytes();
  stats_.light_build_seconds = seconds_since(start);
}

/// Between passes: has better BVHs of large meshes built beside rendering, and takes them.
void Session::refine() {
  if (refinement_ && refinement_->done) {
    refinement_->thread.join();
    const std::unique_lock lock(scene_mutex_);
    accel_->adopt(refinement_->result);
    refinement_.reset();
  }
  if (refinement_ || refined_all_ || !accel_->can_refine()) return;
  // What does not fit into memory, or fails, is not tried again before another edit.
  refined_all_ = true;
  refinement_ = std::make_unique<Refinement>();
  refinement_->thread = std::thread([accel = accel_, &work = *refinement_] {
    constexpr int kThreads = 1;  // rendering has the others
    try {
      work.result = accel->refine(kThreads, work.cancelled);
    } catch (const std::runtime_error&) {
      // The quick ones stay: the picture is the same.
    }
    work.done = true;
  });
}

}  // namespace parian
