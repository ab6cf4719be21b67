/// Questions about what a session renders, from any thread.
#include "renderer/scene/node_bounds.h"
#include "renderer/session/session.h"

namespace parian {

std::shared_ptr<Film> Session::shown_film() const {
  const std::shared_lock lock(scene_mutex_);
  return shown_;
}

std::optional<Pick> Session::pick(float x, float y) const {
  const std::shared_lock lock(scene_mutex_);
  CameraView view = full_.view;
  view.lens_radius = 0;  // by the centre of the lens
  const Ray ray = generate_ray(view, {x, y});
  Hit hit;
  constexpr std::uint32_t kAnyNumber = 0;  // what is blended is there or not, at one place always alike
  if (!accel_->intersect(ray, kAnyNumber, hit)) return std::nullopt;
  Pick pick{scene_, hit_node(*world_, hit), kNone, kNone, kNone, ray.o + ray.d * hit.t, hit.t, 0};
  if (hit.placement != Hit::kAreaLightHit) {
    pick.material = hit_part(*world_, hit).material_index;
    pick.position = make_surface(*scene_, *world_, hit, ray.d).p;
    const int mesh = hit.is_solid() ? kNone : world_->placements[hit.placement].mesh;
    if (mesh != kNone && std::size_t(mesh) < scene_->meshes.size())
      pick.mesh = mesh, pick.primitive = int(hit.primitive);
  }
  pick.depth = (view.to_world.origin - pick.position).dot(view.to_world.z);
  return pick;
}

std::vector<Box3f> Session::node_bounds(std::span<const int> nodes) const {
  const std::shared_lock lock(scene_mutex_);
  return subtree_bounds(*scene_, *world_, nodes);
}

}  // namespace parian
