#include "renderer/scene/camera.h"

namespace parian {

CameraView make_camera_view(const Scene& scene, const CameraPlacement& placement, int width, int height) {
  const Camera& camera = scene.cameras[placement.camera];
  const bool perspective = camera.projection == Projection::perspective;
  CameraView view;
  view.to_world = placement.to_world;
  view.projection = camera.projection;
  const float half_height = perspective ? std::tan(0.5f * camera.yfov) : camera.ymag;
  const float half_width = half_height * float(width) / float(height);
  view.corner = view.to_world.vector({-half_width, half_height, perspective ? -1.0f : 0.0f});
  view.across = view.to_world.x * (2 * half_width / float(width));
  view.down = view.to_world.y * (-2 * half_height / float(height));
  if (camera.lens && perspective) {
    view.lens_radius = camera.lens->focal_length / (2 * camera.lens->f_stop);
    view.focus_distance = camera.lens->focus_distance;
  }
  return view;
}

}  // namespace parian
