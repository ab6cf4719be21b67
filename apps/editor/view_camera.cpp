#include "apps/editor/view_camera.h"

#include <algorithm>
#include <cmath>

namespace parian::editor {
namespace {

constexpr float kTurnPerPixel = 0.006f;  // half a turn for some 500 pixels
constexpr float kSteepest = 0.5f * kPi - 1e-3f;
constexpr float kNearest = 1e-4f, kFarthest = 1e7f;  // of the target, metres

Quatf about(const Vec3f& axis, float angle) {
  Quatf q;
  q.setAxisAngle(axis, angle);
  return q;
}

}  // namespace

Quatf ViewCamera::rotation() const {
  return about({0, 1, 0}, yaw) * about({1, 0, 0}, pitch) * about({0, 0, 1}, roll);
}

Vec3f ViewCamera::axis(int i) const {
  return rotation().rotateVector({i == 0 ? 1.0f : 0, i == 1 ? 1.0f : 0, i == 2 ? 1.0f : 0});
}

Vec3f ViewCamera::eye() const { return target - forward() * distance; }

void ViewCamera::look_through(const Camera& like, const Affine& to_world, float turn_distance) {
  camera = like;
  distance = std::clamp(turn_distance, kNearest, kFarthest);
  const Vec3f z = normalize(to_world.z);
  pitch = std::asin(std::clamp(-z.y, -1.0f, 1.0f));
  yaw = std::abs(z.y) < 0.9999f ? std::atan2(z.x, z.z) : std::atan2(-to_world.x.z, to_world.x.x);
  roll = 0;
  const Vec3f x = normalize(to_world.x);
  roll = std::atan2(x.dot(up()), x.dot(right()));
  target = to_world.origin + forward() * distance;
}

void ViewCamera::aim(float depth) {
  const Vec3f from = eye();
  distance = std::clamp(depth, kNearest, kFarthest);
  target = from + forward() * distance;
}

float ViewCamera::metres_per_pixel(int height) const {
  const float half =
      camera.projection == Projection::perspective ? distance * std::tan(0.5f * camera.yfov) : camera.ymag;
  return 2 * half / float(std::max(1, height));
}

void ViewCamera::orbit(float dx, float dy) {
  roll = 0;
  yaw = std::remainder(yaw - dx * kTurnPerPixel, 2 * kPi);
  pitch = std::clamp(pitch - dy * kTurnPerPixel, -kSteepest, kSteepest);
}

void ViewCamera::turn(float dx, float dy) {
  const Vec3f from = eye();
  orbit(dx, dy);
  target = from + forward() * distance;
}

void ViewCamera::pan(float dx, float dy, int height) {
  target += (up() * dy - right() * dx) * metres_per_pixel(height);
}

void ViewCamera::dolly(float steps) {
  const float factor = std::pow(0.9f, steps);
  if (camera.projection == Projection::orthographic) {
    camera.xmag *= factor;
    camera.ymag *= factor;
  }
  distance = std::clamp(distance * factor, kNearest, kFarthest);
}

void ViewCamera::fly(const Vec3f& move) { target += right() * move.x + up() * move.y + forward() * move.z; }

void ViewCamera::frame(const Box3f& box, float aspect) {
  if (box.isEmpty()) return;
  target = box.center();
  const float radius = std::max(0.5f * box.size().length(), 1e-3f);
  const float size = box.size().length() > 0 ? radius : 0.5f;
  if (camera.projection == Projection::orthographic) {
    camera.ymag = size * std::max(1.0f, 1 / aspect);
    camera.xmag = camera.ymag * aspect;
  }
  // The narrower of the two fields decides.
  const float half = std::min(0.5f * camera.yfov, std::atan(std::tan(0.5f * camera.yfov) * aspect));
  distance = std::clamp(1.05f * size / std::sin(half), kNearest, kFarthest);
}

Scene with_view(const Scene& scene, const ViewCamera& view) {
  Scene result = scene;
  Node node;
  node.name = "viewport";
  node.transform.translation = view.eye();
  node.transform.rotation = view.rotation().normalized();
  node.camera = int(result.cameras.size());
  result.cameras.push_back(view.camera);
  result.roots.insert(result.roots.begin(), int(result.nodes.size()));  // the first camera of the world
  result.nodes.push_back(std::move(node));
  return result;
}

}  // namespace parian::editor
