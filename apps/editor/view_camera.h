/// The eye of the viewport: orbits, pans, dollies, flies. Knows nothing of windows; lengths are metres of
/// world space, angles radians, y is up.
#pragma once

#include "renderer/scene/scene.h"

namespace parian::editor {

/// Looks from `distance` away at `target`, from the direction that yaw and pitch give: at 0 and 0 along -z.
class ViewCamera {
 public:
  Vec3f target{0, 0, 0};
  float distance = 5, yaw = 0, pitch = 0;
  float roll = 0;  // of a scene's camera that was looked through; gone at the first turn
  Camera camera;   // field of view and lens; its aspect is that of the viewport

  /// Looks as a camera at that place does (orthonormal, along -z), turning about a point `distance` ahead.
  void look_through(const Camera& like, const Affine& to_world, float turn_distance);

  Vec3f eye() const;
  /// The rotation of the camera's node.
  Quatf rotation() const;
  Vec3f right() const { return axis(0); }
  Vec3f up() const { return axis(1); }
  Vec3f forward() const { return -axis(2); }
  /// Metres at the target that one pixel of a viewport so high covers.
  float metres_per_pixel(int height) const;

  /// The target is so far ahead, in metres; nothing is seen of that.
  void aim(float depth);

  // What the hand does, in pixels of a viewport `height` high; y is down.
  void orbit(float dx, float dy);            // about the target; stops at the poles
  void turn(float dx, float dy);             // the head: about the eye
  void pan(float dx, float dy, int height);  // what is below the pointer goes with it
  void dolly(float steps);                   // towards the target, a tenth of the way for each step
  /// Moves the eye, and the target with it: metres to the right, up and ahead.
  void fly(const Vec3f& move);

  /// The whole box is seen, from where it is looked from; a box of no size as if it were a metre wide.
  void frame(const Box3f& box, float aspect);

 private:
  Vec3f axis(int i) const;
};

/// `scene` with one more camera behind all others, on a node behind all others, which shows what the view
/// sees: the indices of all else stay.
Scene with_view(const Scene& scene, const ViewCamera& view);

}  // namespace parian::editor
