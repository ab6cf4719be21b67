/// Camera rays.
#pragma once

#include "renderer/scene/world.h"

namespace parian {

/// A camera placed and fitted to an image.
struct CameraView {
  Affine to_world;  // orthonormal, looking along -z
  Projection projection;
  float half_width, half_height;  // of the image plane at distance 1; orthographic: in metres
  float lens_radius = 0, focus_distance = 1;
  int width, height;
};

/// Fits the camera to an image of width x height: the vertical extent (yfov, ymag) is authoritative, the
/// horizontal one follows from the image, so that pixels are square.
CameraView make_camera_view(const Scene& scene, const CameraPlacement& placement, int width, int height);

/// The ray through point `film` (pixels, origin top left, y down) and lens sample `lens` in [0,1)^2: from a
/// uniform point of the lens disk to the point of the plane of focus, which is parallel to the image plane.
/// Unit direction.
Ray generate_ray(const CameraView& view, const Vec2f& film, const Vec2f& lens);

}  // namespace parian
