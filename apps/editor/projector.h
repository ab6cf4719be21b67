/// From world space to the pixels of the viewport and back.
#pragma once

#include <optional>

#include "apps/editor/view_camera.h"
#include "renderer/base/math.h"

namespace parian::editor {

/// How a view is seen in a viewport of width x height pixels; y is down, the origin top left.
class Projector {
 public:
  Projector(const ViewCamera& view, int width, int height)
      : camera_(view.camera),
        eye_(view.eye()),
        right_(view.right()),
        up_(view.up()),
        forward_(view.forward()),
        centre_(0.5f * float(width), 0.5f * float(height)) {
    const bool perspective = camera_.projection == Projection::perspective;
    scale_ = centre_.y / (perspective ? std::tan(0.5f * camera_.yfov) : camera_.ymag);
  }

  /// Nothing for what is behind the eye.
  std::optional<Vec2f> project(const Vec3f& p) const {
    const Vec3f d = p - eye_;
    const float depth = divisor(d);
    if (depth <= 1e-6f) return std::nullopt;
    return centre_ + Vec2f(d.dot(right_), -d.dot(up_)) * (scale_ / depth);
  }

  /// Metres at p that one pixel covers.
  float metres_per_pixel(const Vec3f& p) const { return std::max(divisor(p - eye_), 1e-6f) / scale_; }

  /// The ray through a pixel.
  Ray ray(const Vec2f& pixel) const {
    const Vec2f at = (pixel - centre_) / scale_;
    const Vec3f across = right_ * at.x - up_ * at.y;
    if (camera_.projection == Projection::orthographic) return {eye_ + across, forward_};
    return {eye_, normalize(forward_ + across)};
  }

  const Vec3f& forward() const { return forward_; }
  /// The unit direction from p to the eye.
  Vec3f to_eye(const Vec3f& p) const {
    return camera_.projection == Projection::orthographic ? -forward_ : normalize(eye_ - p);
  }

 private:
  float divisor(const Vec3f& d) const {
    return camera_.projection == Projection::orthographic ? 1 : d.dot(forward_);
  }

  Camera camera_;
  Vec3f eye_, right_, up_, forward_;
  Vec2f centre_;
  float scale_;  // pixels for a tangent, or a metre of an orthographic view
};

}  // namespace parian::editor
