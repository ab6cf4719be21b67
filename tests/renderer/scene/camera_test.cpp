#include "renderer/scene/camera.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1f;

CameraView make_view(const Camera& camera, int width, int height, const Transform& transform = {}) {
  Scene scene;
  add_camera(scene, camera, transform);
  return make_camera_view(scene, place_cameras(scene).at(0), width, height);
}

Camera perspective(float yfov) {
  Camera camera;
  camera.yfov = yfov;
  return camera;
}

/// A lens of diameter .1 focused at 2.
Camera thin_lens() {
  Camera camera = perspective(1);
  camera.lens = Lens{.focal_length = 0.1f, .f_stop = 1, .focus_distance = 2};
  return camera;
}

/// Where the ray crosses the plane z = -depth of the camera's own frame.
Vec3f at_depth(const CameraView& view, const Ray& ray, float depth) {
  const Affine& m = view.to_world;
  const float toward = -ray.d.dot(m.z), from = -(ray.o - m.origin).dot(m.z);
  const Vec3f p = ray.o + ray.d * ((depth - from) / toward) - m.origin;
  return {p.dot(m.x), p.dot(m.y), p.dot(m.z)};
}

void expect_near(const Vec3f& a, const Vec3f& b, float tolerance = 2e-6f) {
  EXPECT_LE((a - b).length(), tolerance)
      << "(" << a.x << ", " << a.y << ", " << a.z << ") is not (" << b.x << ", " << b.y << ", " << b.z << ")";
}

TEST(Camera, LooksAlongMinusZWithTheImageUpright) {
  const CameraView view = make_view(perspective(kPi / 2), 200, 100);
  expect_near(generate_ray(view, {100, 50}, {0, 0}).d, {0, 0, -1});
  const float half = std::sqrt(0.5f);
  expect_near(generate_ray(view, {100, 0}, {0, 0}).d, {0, half, -half});
  expect_near(generate_ray(view, {100, 100}, {0, 0}).d, {0, -half, -half});
  expect_near(generate_ray(view, {0, 50}, {0, 0}).d, normalize(Vec3f(-2, 0, -1)));
  expect_near(generate_ray(view, {200, 50}, {0, 0}).d, normalize(Vec3f(2, 0, -1)));
  expect_near(generate_ray(view, {7, 90}, {0.3f, 0.7f}).o, {0, 0, 0});
}

// The vertical angle is authoritative and pixels are square, whatever the image and the file's aspect.
TEST(Camera, PixelsAreSquare) {
  Camera camera = perspective(0.7f);
  camera.aspect = 3;
  for (const auto& [width, height] : {std::pair(640, 480), {100, 100}, {90, 160}}) {
    const CameraView view = make_view(camera, width, height);
    const Vec3f center = at_depth(view, generate_ray(view, {float(width) / 2, float(height) / 2}), 1);
    const Vec3f right = at_depth(view, generate_ray(view, {float(width) / 2 + 1, float(height) / 2}), 1);
    const Vec3f down = at_depth(view, generate_ray(view, {float(width) / 2, float(height) / 2 + 1}), 1);
    const float pixel = 2 * std::tan(0.35f) / float(height);
    expect_near(right - center, {pixel, 0, 0}, 1e-6f);
    expect_near(down - center, {0, -pixel, 0}, 1e-6f);
  }
}

// A sphere of radius 1 at distance 3, yfov 60 degrees, has an image of radius .612372 of the
// half-image; R / d would be .57735.
TEST(Camera, ASphereHasItsPerspectiveRadius) {
  const CameraView view = make_view(perspective(kPi / 3), 400, 300);
  const auto distance_to_center = [&](const Vec2f& film) {
    const Ray ray = generate_ray(view, film);
    return ray.d.cross(Vec3f(0, 0, -3) - ray.o).length();
  };
  EXPECT_NEAR(distance_to_center({200, 150 + 150 * 0.612372f}), 1, 2e-6);
  EXPECT_NEAR(distance_to_center({200 - 150 * 0.612372f, 150}), 1, 2e-6);
}

TEST(Camera, OrthographicRaysAreParallel) {
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.xmag = 9;
  camera.ymag = 2;
  camera.lens = Lens{};
  const CameraView view = make_view(camera, 300, 200, look_along({1, 2, 3}, {1, 0, 0}));
  for (const Vec2f& film : {Vec2f(0, 0), Vec2f(150, 100), Vec2f(300, 200), Vec2f(17, 150)}) {
    const Ray ray = generate_ray(view, film, {0.5f, 0.5f});
    expect_near(ray.d, {1, 0, 0});
    // Looking along x with y up, the right of the image is +z.
    const float right = (film.x / 150 - 1) * 3, up = (1 - film.y / 100) * 2;
    expect_near(ray.o, {1, 2 + up, 3 + right});
  }
}

// A camera ignores its node's scale, mirrored or not.
TEST(Camera, StandsWhereItsNodeIs) {
  Transform t;
  t.translation = {1, 2, 3};
  t.rotation.setAxisAngle({0, 1, 0}, kPi / 2);
  t.scale = {2, 5, 0.1f};
  const CameraView view = make_view(thin_lens(), 100, 100, t);
  TestRandom random(1);
  for (int i = 0; i < 1000; ++i) {
    const Ray ray = generate_ray(view, random.next2() * 100, random.next2());
    ASSERT_NEAR(ray.d.length(), 1, 1e-6);
    ASSERT_LE((ray.o - Vec3f(1, 2, 3)).length(), 0.05f + 1e-6f);
    ASSERT_NEAR(ray.o.x, 1, 1e-6) << "the lens is across the view";
    ASSERT_EQ(ray.tmax, kInfinity);
  }
  expect_near(generate_ray(make_view(perspective(1), 100, 100, t), {50, 50}).d, {-1, 0, 0});
}

// E[r] = 2 R / 3, a quarter within R / 2. Catches r = R u.
TEST(Lens, IsSampledUniformly) {
  const CameraView view = make_view(thin_lens(), 100, 100);
  EXPECT_FLOAT_EQ(view.lens_radius, 0.05f) << "focal length over twice the f-stop";
  TestRandom random(2);
  Statistics radius, inner, x, y;
  for (int i = 0; i < 100000; ++i) {
    const Ray ray = generate_ray(view, {30, 80}, random.next2());
    const float r = ray.o.length();
    radius.add(r);
    inner.add(r < 0.025f);
    x.add(ray.o.x);
    y.add(ray.o.y);
    ASSERT_EQ(ray.o.z, 0);
  }
  EXPECT_TRUE(mean_is(radius, 0.05 * 2 / 3, 0.01));
  EXPECT_TRUE(mean_is(inner, 0.25, 0.03));
  EXPECT_TRUE(mean_is(x, 0, 0.001));
  EXPECT_TRUE(mean_is(y, 0, 0.001));
}

// All rays of a film point meet on the plane of focus, where the pinhole's ray crosses it. Catches
// focus at a distance along the ray, which curves the plane.
TEST(Lens, FocusesOnAPlane) {
  const Transform pose = look_along({3, -1, 2}, normalize(Vec3f(1, 2, -2)));
  const CameraView view = make_view(thin_lens(), 160, 90, pose),
                   pinhole = make_view(perspective(1), 160, 90, pose);
  TestRandom random(3);
  for (const Vec2f& film : {Vec2f(80, 45), Vec2f(0, 0), Vec2f(155, 10)}) {
    const Vec3f focus = at_depth(pinhole, generate_ray(pinhole, film), 2);
    for (int i = 0; i < 100; ++i)
      expect_near(at_depth(view, generate_ray(view, film, random.next2()), 2), focus, 5e-6f);
  }
}

// A point at depth z is a circle of diameter A |z - z_f| / z on the plane of focus. The bundle of the
// image's middle has a diameter at z that, seen from the lens, is as large.
TEST(Lens, HasTheRightCircleOfConfusion) {
  const CameraView view = make_view(thin_lens(), 100, 100);
  for (const auto& [z, circle] :
       {std::pair(1.0f, 0.1), {1.5f, 0.1 / 3}, {2.0f, 0.0}, {4.0f, 0.05}, {1e6f, 0.1}}) {
    const Vec3f a = at_depth(view, generate_ray(view, {50, 50}, {kBelowOne, 0}), z),
                b = at_depth(view, generate_ray(view, {50, 50}, {kBelowOne, 0.5f}), z);
    EXPECT_NEAR((a - b).length() * 2 / z, circle, 1e-5) << z;
  }
}

}  // namespace
}  // namespace parian
