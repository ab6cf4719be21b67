#include "renderer/scene/camera.h"

#include "renderer/base/sampling.h"

namespace parian {

CameraView make_camera_view(const Scene& scene, const CameraPlacement& placement, int width, int height) {
  const Camera& camera = scene.cameras[placement.camera];
  CameraView view;
  view.to_world = placement.to_world;
  view.projection = camera.projection;
  view.half_height =
      camera.projection == Projection::perspective ? std::tan(0.5f * camera.yfov) : camera.ymag;
  view.half_width = view.half_height * float(width) / float(height);
  if (camera.lens && camera.projection == Projection::perspective) {
    view.lens_radius = camera.lens->focal_length / (2 * camera.lens->f_stop);
    view.focus_distance = camera.lens->focus_distance;
  }
  view.width = width;
  view.height = height;
  return view;
}

Ray generate_ray(const CameraView& view, const Vec2f& film, const Vec2f& lens) {
  const float x = (2 * film.x / float(view.width) - 1) * view.half_width;
  const float y = (1 - 2 * film.y / float(view.height)) * view.half_height;
  if (view.projection == Projection::orthographic)
    return {view.to_world.point({x, y, 0}), view.to_world.vector({0, 0, -1})};
  if (view.lens_radius == 0) return {view.to_world.origin, normalize(view.to_world.vector({x, y, -1}))};
  const Vec2f on_lens = sample_disk(lens) * view.lens_radius;
  const Vec3f focus = Vec3f(x, y, -1) * view.focus_distance;
  return {view.to_world.point({on_lens.x, on_lens.y, 0}),
          normalize(view.to_world.vector(focus - Vec3f(on_lens.x, on_lens.y, 0)))};
}

}  // namespace parian
