/// Camera rays.
#pragma once

#include "renderer/base/sampling.h"
#include "renderer/scene/world.h"

namespace parian {

/// A camera placed and fitted to an image.
struct CameraView {
  Affine to_world;  // orthonormal, looking along -z
  Projection projection;
  // The point (x, y) of the film, in pixels, stands for corner + across x + down y, in world space, as seen
  // from the centre of the lens: on the image plane at distance 1; orthographic: at distance 0.
  Vec3f corner, across, down;
  float lens_radius = 0, focus_distance = 1;

  bool is_pinhole() const { return projection == Projection::perspective && lens_radius == 0; }
};

/// Fits the camera to an image of width x height: the vertical extent (yfov, ymag) is authoritative, the
/// horizontal one follows from the image, so that pixels are square.
CameraView make_camera_view(const Scene& scene, const CameraPlacement& placement, int width, int height);

/// The unit direction of the ray through point `film` of a pinhole camera.
inline Vec3f pinhole_direction(const CameraView& view, const Vec2f& film) {
  return normalize(view.corner + view.across * film.x + view.down * film.y);
}

/// The ray through point `film` (pixels, origin top left, y down) and lens sample `lens` in [0,1)^2: from a
/// uniform point of the lens disk to the point of the plane of focus, which is parallel to the image plane.
/// Unit direction.
inline Ray generate_ray(const CameraView& view, const Vec2f& film, const Vec2f& lens = Vec2f(0)) {
  const Affine& m = view.to_world;
  const Vec3f point = view.corner + view.across * film.x + view.down * film.y;
  if (view.projection == Projection::orthographic) return {m.origin + point, -m.z};
  if (view.is_pinhole()) return {m.origin, pinhole_direction(view, film)};
  const Vec2f disk = sample_disk(lens) * view.lens_radius;
  const Vec3f on_lens = m.x * disk.x + m.y * disk.y;
  return {m.origin + on_lens, normalize(point * view.focus_distance - on_lens)};
}

}  // namespace parian
