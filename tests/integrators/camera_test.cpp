// Cameras through the whole pipeline: what lands where on the film, and the layers and
// occlusion of what they see.
#include <gtest/gtest.h>

#include "tests/integrators/support/render.h"
#include "tests/integrators/support/shapes.h"

namespace parian {
namespace {

/// A camera in the origin, focused at distance 2 with a lens of diameter .1, that sees a square of side 2
/// `half` there.
Camera lens_camera(float half) {
  Camera camera;
  camera.yfov = 2 * std::atan(half / 2);
  camera.lens = Lens{};
  camera.lens->focal_length = 0.2f;
  camera.lens->f_stop = 2;
  camera.lens->focus_distance = 2;
  return camera;
}

/// Second moment about the middle of the picture, and the share of its light within half of `radius`; in
/// units of the plane of focus, where the picture is 2 `half` wide.
struct Blur {
  double variance, inner_share;
};
Blur measure_blur(const Picture& p, double half, double radius) {
  double sum = 0, moment = 0, inner = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      const double px = (2 * (x + 0.5) / p.width - 1) * half, py = (2 * (y + 0.5) / p.height - 1) * half;
      const double c = p.at(x, y)[0], r2 = px * px + py * py;
      sum += c;
      moment += c * r2;
      if (r2 < radius * radius / 4) inner += c;
    }
  return {moment / sum, inner / sum};
}

// The circle of confusion on the plane of focus is A |z - zf| / z. A quarter of it lies within
// half its radius. Caught: focus at a radial distance, radius for diameter, r = R u in place of R sqrt(u).
TEST(Lens, CircleOfConfusion) {
  for (const float z : {1.0f, 1.5f, 4.0f, 2000.0f}) {
    const double blur = 0.1 * std::abs(z - 2) / z, half = 0.75 * blur;
    Scene scene;
    // A small emitter: its image, a square of a tenth of the blur, widens the second moment by side^2 / 6.
    const float side = float(0.1 * blur) * z / 2;
    add_mesh(scene, make_quad({0, 0, -z}, {side / 2, 0, 0}, {0, side / 2, 0}),
             add_material(scene, make_emitter({1, 1, 1})));
    add_camera(scene, lens_camera(float(half)));
    const Picture p = render(scene, independent_settings(50, 50, 400));
    const Blur b = measure_blur(p, half, blur / 2);
    const double pixel = 2 * half / 50,
                 truth = blur * blur / 8 + std::pow(0.1 * blur, 2) / 6 + pixel * pixel / 6;
    EXPECT_NEAR(b.variance / truth, 1, 0.05) << "at " << z;
    EXPECT_NEAR(b.inner_share, 0.25, 0.03) << "at " << z;
  }
}

// What lies in the plane of focus is sharp, also far from the axis, where a sphere of focus would blur it.
TEST(Lens, ThePlaneOfFocusIsSharp) {
  Scene scene;
  add_mesh(scene, make_quad({1, 0, -2}, {1, 0, 0}, {0, 3, 0}), add_material(scene, make_emitter({1, 1, 1})));
  add_camera(scene, lens_camera(1.9f));
  const Picture p = render(scene, independent_settings(64, 64, 32));
  for (int y = 0; y < 64; ++y) {
    // The emitter's edges, at x = 0 and 2 > 1.9, lie between pixels.
    EXPECT_EQ(p.at(31, y)[0], 0);
    EXPECT_EQ(p.at(32, y)[0], 1);
    EXPECT_EQ(p.at(63, y)[0], 1);
  }
}

// No cos^4, no vignetting. Caught: a lens weighted by its cosine.
TEST(Lens, AConstantEnvironmentStaysConstant) {
  Scene scene;
  scene.environment.radiance = Rgb(1, 2, 3);
  add_camera(scene, lens_camera(2));
  const Picture p = render(scene, independent_settings(32, 32, 4));
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      for (int k = 0; k < 3; ++k) ASSERT_EQ(p.at(x, y)[k], float(k + 1));
}

// The image of a sphere of radius 1 at distance 3. Caught: radius / distance gives .577 of the
// half-image.
TEST(Perspective, SphereOnTheAxis) {
  Scene scene;
  add_mesh(scene, make_flat_sphere({0, 0, -3}, 1, 128), add_material(scene, make_emitter({1, 1, 1})));
  Camera camera;
  camera.yfov = kPi / 3;
  add_camera(scene, camera);
  const Picture p = render(scene, independent_settings(200, 200, 32));
  const double radius = std::sqrt(mean_of(p, 0).value * 4 / std::numbers::pi);
  EXPECT_NEAR(radius, 0.612372, 5e-4);
  // Wide pictures see more to the sides, at the same height.
  const Picture wide = render(scene, independent_settings(400, 200, 8));
  EXPECT_NEAR(std::sqrt(2 * mean_of(wide, 0).value * 4 / std::numbers::pi), 0.612372, 1e-3);
}

// Caught: y upside down, x mirrored, the camera's own axes taken for the world's.
TEST(Perspective, DirectionsOnTheFilm) {
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    Scene scene;
    // Seen from +x towards -x: right is -z, up is +y.
    add_mesh(scene, make_quad({-2, 0.5f, -0.5f}, {0, 0.3f, 0}, {0, 0, 0.3f}),
             add_material(scene, make_emitter({1, 1, 1})));
    Camera camera;
    camera.projection = projection;
    camera.yfov = kPi / 4;
    add_camera(scene, camera, look_along({1, 0, 0}, {-1, 0, 0}));
    const Picture p = render(scene, independent_settings(64, 64, 4));
    EXPECT_GT(mean_of(p, 0, {32, 0, 64, 32}).value, 0.1);  // top right
    EXPECT_LT(mean_of(p, 0, {0, 0, 32, 64}).value, 0.01);
    EXPECT_LT(mean_of(p, 0, {32, 32, 64, 64}).value, 0.01);
  }
}

TEST(Orthographic, MagnificationIsHalfTheHeight) {
  Scene scene;
  add_mesh(scene, make_quad({0, 0, -50}, {1, 0, 0}, {0, 0.5f, 0}),
           add_material(scene, make_emitter({1, 1, 1})));
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.xmag = camera.ymag = 2;
  add_camera(scene, camera);
  EXPECT_NEAR(mean_of(render(scene, independent_settings(64, 64, 4)), 0).value, 2.0 / 16, 1e-3);
  EXPECT_NEAR(mean_of(render(scene, independent_settings(128, 64, 4)), 0).value, 2.0 / 32, 1e-3);
}

Scene floor_and_wall() {
  Scene scene;
  add_receiver(scene, Rgb(0.5f, 0.5f, 0.5f));
  add_mesh(scene, make_quad({0, 0.5f, -1}, {1, 0, 0}, {0, 0.5f, 0}), 0);
  return scene;
}

// A wall of 2 x 1 at distance 1 blocks its form factor, 2 x .055734; a tall and wide one close by blocks
// half. Caught: a uniform hemisphere (a fifth more is blocked), rays that start below the surface.
TEST(AmbientOcclusion, WallsBlockTheirFormFactor) {
  EXPECT_TRUE(mean_is(mean_of(render(floor_and_wall(), independent_settings(64, 64, 64), {}, "ao"), 0),
                      1 - 2 * 0.055734, 0.006));
  Scene corner;
  add_receiver(corner, Rgb(0.5f, 0.5f, 0.5f));
  add_mesh(corner, make_quad({0, 500, -0.01f}, {500, 0, 0}, {0, 500, 0}), 0);
  EXPECT_TRUE(mean_is(mean_of(render(corner, independent_settings(64, 64, 64), {}, "ao"), 0), 0.5, 0.011));
}

TEST(AmbientOcclusion, DistanceLimitsOccluders) {
  IntegratorSettings settings;
  settings.occlusion_distance = 0.9f;
  EXPECT_EQ(mean_of(render(floor_and_wall(), independent_settings(16, 16, 16), settings, "ao"), 0).value, 1);
  settings.occlusion_distance = 100;
  EXPECT_LT(mean_of(render(floor_and_wall(), independent_settings(16, 16, 16), settings, "ao"), 0).value,
            0.95);
}

TEST(AmbientOcclusion, BackgroundIsWhite) {
  Scene scene;
  add_camera(scene, Camera{});
  EXPECT_EQ(mean_of(render(scene, independent_settings(8, 8, 1), {}, "ao"), 0).value, 1);
}

/// A square of a known colour that faces the camera from 3 away, on the left half of the picture.
Scene half_square() {
  Scene scene;
  add_mesh(scene, make_quad({-5, 0, -3}, {5, 0, 0}, {0, 10, 0}),
           add_material(scene, make_lambert({0.2f, 0.4f, 0.8f})));
  Camera camera;
  camera.projection = Projection::orthographic;
  add_camera(scene, camera);
  return scene;
}

TEST(FirstHit, ShowsAlbedoNormalAndDepth) {
  const Rgb expected[] = {{0.2f, 0.4f, 0.8f}, {0.5f, 0.5f, 1}, {3, 3, 3}};
  const char* names[] = {"albedo", "normal", "depth"};
  for (int i = 0; i < 3; ++i) {
    const Picture p = render(half_square(), independent_settings(16, 16, 4), {}, names[i]);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(p.at(3, 8)[k], expected[i][k], 1e-5) << names[i];
      EXPECT_EQ(p.at(12, 8)[k], 0) << names[i];
    }
  }
}

// The layers of the film come from any integrator; the background leaves them zero. Caught: normals that face
// away, depth along the axis in place of along the ray, ids of meshes for ids of nodes.
TEST(Layers, HoldWhatTheFirstHitIs) {
  Scene scene = half_square();
  add_light(scene, make_area_light(LightKind::rectangle, 1, 10, 10), look_along({5, 0, -4}, {0, 0, 1}));
  Camera& camera = scene.cameras[0];
  camera.projection = Projection::perspective;
  camera.yfov = 1;
  RenderSettings settings = independent_settings(32, 32, 4);
  settings.layers = {true, true, true};
  for (const char* name : {"path", "ao", "albedo"}) {
    const Picture p = render(scene, settings, {}, name);
    const std::size_t albedo = channel_of(p, "albedo.R"), normal = channel_of(p, "normal.X"),
                      depth = channel_of(p, "depth.Z"), object = channel_of(p, "object.id");
    const float* left = p.at(4, 16);
    EXPECT_NEAR(left[albedo], 0.2f, 1e-6);
    EXPECT_NEAR(left[albedo + 2], 0.8f, 1e-6);
    EXPECT_NEAR(left[normal + 2], 1, 1e-6);
    const float x = (2 * 4.5f / 32 - 1) * std::tan(0.5f), y = (1 - 2 * 16.5f / 32) * std::tan(0.5f);
    EXPECT_NEAR(left[depth], 3 * std::sqrt(1 + x * x + y * y), 0.05);
    EXPECT_EQ(left[object], 1);
    const float* right = p.at(28, 16);  // the light
    EXPECT_EQ(right[albedo], 0);
    EXPECT_NEAR(right[normal + 2], 1, 1e-6);
    EXPECT_EQ(right[object], 3);
    EXPECT_EQ(left[channel_of(p, "samples")], 4);
  }
}

TEST(Layers, BackgroundIsZero) {
  RenderSettings settings = independent_settings(16, 16, 2);
  settings.layers = {false, false, true};
  const Picture p = render(half_square(), settings);
  for (std::size_t c = 0; c < p.channels.size(); ++c) EXPECT_EQ(p.at(12, 3)[c], 0) << p.channels[c];
}

TEST(Integrators, AreKnownByName) {
  EXPECT_EQ(integrator_names(), (std::vector<std::string>{"path", "ao", "albedo", "normal", "depth"}));
  for (const std::string& name : integrator_names()) EXPECT_TRUE(make_integrator(name, {}));
  EXPECT_ANY_THROW(make_integrator("photon", {}));
}

}  // namespace
}  // namespace parian
