// Pictures whose radiance is known in closed form: furnaces, light of every kind, the environment. Scenes by
// their number among the ground truths (GT).
#include <gtest/gtest.h>

#include <array>

#include "renderer/base/random.h"
#include "tests/integrators/support/render.h"
#include "tests/integrators/support/shapes.h"

namespace parian {
namespace {

struct NamedShape {
  const char* name;
  Primitive primitive;
};

std::vector<NamedShape> convex_shapes() {
  return {{"sphere", make_flat_sphere({0, 0, 0}, 1, 24)},
          {"box", make_box({-0.7f, -0.7f, -0.7f}, {0.7f, 0.7f, 0.7f})},
          {"cylinder", make_prism(40, 0.8f, 0.8f, 1.2f)},
          {"cone", make_prism(40, 0.9f, 0, 1.3f)}};
}

/// A convex body in a constant environment of radiance 1.
Scene furnace(const Primitive& primitive, const Rgb& albedo) {
  Scene scene;
  add_mesh(scene, primitive, add_material(scene, make_lambert(albedo)));
  scene.environment.radiance = Rgb(1, 1, 1);
  add_eye(scene, {2, 2.5f, 3}, {0, 0.3f, 0}, 0.75f);
  return scene;
}

// Albedo 1: each path brings exactly 1, so each pixel must be 1. Caught: self-hits, flipped normals.
TEST(Furnace, EveryPixelOfAWhiteConvexBodyIsOne) {
  for (const NamedShape& shape : convex_shapes())
    for (const Strategy strategy : {Strategy::bsdf, Strategy::mis}) {
      const Scene scene = furnace(shape.primitive, Rgb(1, 1, 1));
      // One scattering event: a path that met the body again would stay dark.
      const Picture p = render(scene, independent_settings(128, 128, 16), with(strategy, 1));
      double worst = 0, sum = 0;
      for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) {
          worst = std::max(worst, std::abs(double(p.at(x, y)[0]) - 1));
          sum += p.at(x, y)[0];
        }
      if (strategy == Strategy::bsdf) {
        EXPECT_LT(worst, 1e-5) << shape.name;
      }
      EXPECT_NEAR(sum / (p.width * p.height), 1, 0.005) << shape.name;
    }
}

// Other albedos: radiance is albedo times 1. Caught: 1/pi left out or doubled, a uniform density
// claimed for the cosine's, light that leaks through the body.
TEST(Furnace, ConvexBodiesReflectTheirAlbedo) {
  for (const NamedShape& shape : convex_shapes())
    for (const Strategy strategy : {Strategy::bsdf, Strategy::mis, Strategy::light}) {
      Scene scene = furnace(shape.primitive, Rgb(0.2f, 0.5f, 0.8f));
      add_probe(scene, {0, 0.4f, 0}, normalize(Vec3f(1, 0.4f, 2)), 5, 0.1f);
      std::swap(scene.cameras[0], scene.cameras[1]);
      std::swap(scene.nodes[1].transform, scene.nodes[2].transform);
      const Picture p =
          render(scene, independent_settings(64, 64, strategy == Strategy::light ? 192 : 96), with(strategy));
      const double truths[] = {0.2, 0.5, 0.8};
      for (int k = 0; k < 3; ++k)
        EXPECT_TRUE(mean_is(mean_of(p, k), truths[k], 0.01)) << shape.name << ", strategy " << int(strategy);
    }
}

/// A closed body seen from inside, which emits 1 and reflects .5, .8 and .9.
Scene closed_emitter(const Primitive& outside, const Transform& transform = {}) {
  Scene scene;
  Material m = make_lambert({0.5f, 0.8f, 0.9f});
  m.emission = {1, 1, 1};
  add_mesh(scene, turned(outside), add_material(scene, m), transform);
  add_eye(scene, {0.1f, 0.35f, 0.05f}, {0.9f, -0.2f, 0.6f}, 2);
  return scene;
}

// Caught: missing caps, self-hits and leaks darken it; roulette without its weight gives 4.3 for 10.
TEST(Furnace, ClosedEmittersSumTheSeries) {
  for (const NamedShape& shape : convex_shapes()) {
    const Picture p =
        render(closed_emitter(shape.primitive), independent_settings(64, 64, 56), with(Strategy::bsdf));
    const double truths[] = {2, 5, 10};
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(mean_is(mean_of(p, k), truths[k], 0.01)) << shape.name;
  }
}

// The same with light sampled: the shadow rays, the emitters' densities and the weights are in it.
TEST(Furnace, ClosedEmittersSumTheSeriesWithLightSampling) {
  for (const Strategy strategy : {Strategy::mis, Strategy::light}) {
    const Scene scene = closed_emitter(make_box({-0.7f, -0.7f, -0.7f}, {0.7f, 0.7f, 0.7f}));
    const Picture p = render(scene, independent_settings(64, 64, 64), with(strategy, 8));
    const double truths[] = {0.5, 0.8, 0.9};
    for (int k = 0; k < 3; ++k)
      EXPECT_TRUE(mean_is(mean_of(p, k), (1 - std::pow(truths[k], 9)) / (1 - truths[k]),
                          strategy == Strategy::mis ? 0.01 : 0.05))
          << "strategy " << int(strategy);
  }
}

// Caught: the sign of the determinant not taken out of normals, so that a mirrored emitter shines
// outwards.
TEST(Furnace, MirroredAndStretchedEmittersShineInwards) {
  Transform t;
  t.scale = {-1, 1.5f, 1};
  t.rotation = Quatf(0.9f, 0.1f, 0.3f, 0.2f).normalized();
  Scene scene = closed_emitter(make_flat_sphere({0, 0, 0}, 1, 12), t);
  const Picture p = render(scene, independent_settings(64, 64, 64), with(Strategy::mis, 4));
  const double truths[] = {0.5, 0.8, 0.9};
  for (int k = 0; k < 3; ++k)
    EXPECT_TRUE(mean_is(mean_of(p, k), (1 - std::pow(truths[k], 5)) / (1 - truths[k]), 0.01));
}

TEST(NightlyFurnace, ClosedEmittersSumTheSeriesToHalfAPercent) {
  for (const NamedShape& shape : convex_shapes())
    for (const Strategy strategy : {Strategy::bsdf, Strategy::mis}) {
      const Picture p =
          render(closed_emitter(shape.primitive), independent_settings(64, 64, 400), with(strategy));
      const double truths[] = {2, 5, 10};
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(mean_is(mean_of(p, k), truths[k], 0.005)) << shape.name;
    }
}

// N scattering events leave out the fraction albedo^(N + 1). Caught: a depth that counts one more or
// less.
TEST(Furnace, DepthCutsTheSeries) {
  const Scene scene = closed_emitter(make_box({-0.7f, -0.7f, -0.7f}, {0.7f, 0.7f, 0.7f}));
  for (const int depth : {0, 1, 5, 50}) {
    const Picture p = render(scene, independent_settings(64, 64, 64), with(Strategy::bsdf, depth));
    const double truths[] = {0.5, 0.8, 0.9};
    for (int k = 0; k < 3; ++k)
      EXPECT_TRUE(mean_is(mean_of(p, k), (1 - std::pow(truths[k], depth + 1)) / (1 - truths[k]), 0.01))
          << depth;
  }
}

// Caught: survivors not weighted give 4.28.
TEST(Furnace, RouletteIsUnbiased) {
  Scene scene = closed_emitter(make_box({-0.7f, -0.7f, -0.7f}, {0.7f, 0.7f, 0.7f}));
  scene.materials[0].base_color = {0.9f, 0.9f, 0.9f};
  const Picture p = render(scene, independent_settings(64, 64, 96), with(Strategy::bsdf, 1000));
  EXPECT_TRUE(mean_is(mean_of(p, 1), 10, 0.01));
}

// The indirect light in a sphere is the same everywhere, wherever in it the lamp is. Direct light alone
// comes from a render of one scattering event.
TEST(Furnace, IntegratingSphereSpreadsIndirectLight) {
  Scene scene;
  add_mesh(scene, turned(make_flat_sphere({0, 0, 0}, 1, 64)),
           add_material(scene, make_lambert({0.5f, 0.8f, 0.2f})));
  add_light(scene, Light{}, translate({0.3f, 0.4f, -0.2f}));
  add_eye(scene, {-0.1f, 0.2f, 0.3f}, {0.7f, -0.6f, -1}, 2);
  const RenderSettings settings = independent_settings(64, 64, 128);
  const Picture all = render(scene, settings), direct = render(scene, settings, with(Strategy::mis, 1));
  const double albedos[] = {0.5, 0.8, 0.2};
  for (int k = 0; k < 3; ++k) {
    const double irradiance = albedos[k] / (1 - albedos[k]);  // flux 4 pi over an area of 4 pi
    const double truth = irradiance * albedos[k] / std::numbers::pi;
    for (const Tile& area : {Tile{0, 0, 64, 64}, Tile{0, 0, 32, 64}, Tile{32, 0, 64, 32}}) {
      const Mean a = mean_of(all, k, area), b = mean_of(direct, k, area);
      EXPECT_TRUE(mean_is({a.value - b.value, std::hypot(a.error, b.error)}, truth, 0.03)) << k;
    }
  }
}

/// Form factor of a sphere at distance h radii, its centre at angle t from the normal.
double sphere_form_factor(double h, double t) {
  if (std::cos(t) * h >= 1) return std::cos(t) / (h * h);
  if (std::cos(t) * h <= -1) return 0;
  const double q = std::sqrt(h * h - 1), pi = std::numbers::pi;
  return 0.5 - std::asin(q / (h * std::sin(t))) / pi +
         (std::cos(t) * std::acos(-q / std::tan(t)) - q * std::sqrt(1 - h * h * std::cos(t) * std::cos(t))) /
             (pi * h * h);
}

struct SphereCase {
  double h, degrees, tolerance;
};

void expect_sphere_light(const SphereCase& c, std::uint32_t spp, double tolerance) {
  Scene scene;
  add_receiver(scene, Rgb(0.5f, 0.5f, 0.5f));
  // A polyhedron whose area, and so its mean projection, is that of the unit sphere.
  const Primitive unit = make_flat_sphere({0, 0, 0}, 1, 64);
  const auto radius = float(std::sqrt(4 * std::numbers::pi / area_of(unit)));
  const double t = c.degrees * std::numbers::pi / 180;
  add_mesh(scene, make_flat_sphere({0, 0, 0}, radius, 64), add_material(scene, make_emitter({3, 3, 3})),
           translate({float(c.h * std::sin(t)), float(c.h * std::cos(t)), 0}));
  const Picture p = render(scene, independent_settings(64, 64, spp));
  EXPECT_TRUE(mean_is(mean_of(p, 0), 3 * 0.5 * sphere_form_factor(c.h, t), tolerance))
      << c.h << ", " << c.degrees;
}

// Also for spheres half below the horizon. Caught: cos / h^2 there, which is off by 9% or all of it;
// the light's area taken in its own space.
TEST(DirectLight, SphereLights) {
  EXPECT_NEAR(sphere_form_factor(2, std::numbers::pi * 75 / 180), 0.070410, 1e-6);
  EXPECT_NEAR(sphere_form_factor(1.2, std::numbers::pi * 90 / 180), 0.166943, 1e-6);
  for (const SphereCase& c : {SphereCase{2, 60, 0.03},
                              {2, 75, 0.03},
                              {2, 90, 0.03},
                              {2, 110, 0.08},
                              {1.2, 90, 0.04},
                              {3.5, 20, 0.02}})
    expect_sphere_light(c, 64, c.tolerance);
}

TEST(NightlyDirectLight, SphereLights) {
  for (const SphereCase& c :
       {SphereCase{2, 60, 0.004}, {2, 75, 0.004}, {2, 90, 0.004}, {2, 110, 0.01}, {1.2, 90, 0.005}})
    expect_sphere_light(c, 4096, c.tolerance);
}

// Lights with an area, each as a light and as an emissive mesh. Caught: radiance taken as radiant
// exitance (pi), a disk sampled as its square, a light that shines backwards.
TEST(DirectLight, RectanglesAndDisks) {
  struct Case {
    const char* name;
    LightKind kind;
    float width, height;
    Transform at;
    double truth;
  };
  Transform down;  // -z turned to -y, at height 1
  down = look_along({0, 1, 0}, {0, -1, 0});
  const Case cases[] = {
      {"disk of radius .5 at .7", LightKind::disk, 1, 1, look_along({0, 0.7f, 0}, {0, -1, 0}),
       0.25 / (0.25 + 0.49)},
      {"2 x 2 square", LightKind::rectangle, 2, 2, down, 0.554126},
      {"1 x 1 square", LightKind::rectangle, 1, 1, down, 0.239456},
      {"perpendicular 2 x 1", LightKind::rectangle, 2, 1, look_along({0, 0.5f, -1}, {0, 0, 1}), 2 * 0.055734},
      {"perpendicular 1 x 1", LightKind::rectangle, 1, 1, look_along({0.5f, 0.5f, -1}, {0, 0, 1}), 0.055734}};
  for (const Case& c : cases)
    for (const bool mesh : {false, true}) {
      if (mesh && c.kind == LightKind::disk) continue;
      for (const bool backwards : {false, true}) {
        Scene scene;
        add_receiver(scene, Rgb(0.2f, 0.4f, 0.8f));
        Transform at = c.at;
        if (backwards) {  // turned round its y axis
          for (const int row : {0, 2})
            for (int k = 0; k < 3; ++k) (*at.matrix)[row][k] *= -1;
        }
        if (mesh) {
          add_mesh(scene, turned(make_quad({0, 0, 0}, {c.width / 2, 0, 0}, {0, c.height / 2, 0})),
                   add_material(scene, make_emitter({2, 2, 2})), at);
        } else {
          add_light(scene, make_area_light(c.kind, 2, c.width, c.height), at);
        }
        const Picture p = render(scene, independent_settings(64, 64, backwards ? 4 : 64));
        const double albedos[] = {0.2, 0.4, 0.8};
        for (int k = 0; k < 3; ++k) {
          if (backwards)
            EXPECT_EQ(mean_of(p, k).value, 0) << c.name;
          else
            EXPECT_TRUE(mean_is(mean_of(p, k), 2 * albedos[k] * c.truth, 0.01))
                << c.name << (mesh ? ", mesh" : "");
        }
      }
    }
}

// A disk's light as a strategy of its own: the pdf knows that the square's corners are not there.
TEST(DirectLight, DisksByEitherStrategy) {
  Scene scene;
  add_receiver(scene, Rgb(0.5f, 0.5f, 0.5f));
  add_light(scene, make_area_light(LightKind::disk, 2, 2), look_along({0, 1, 0}, {0, -1, 0}));
  for (const Strategy strategy : {Strategy::light, Strategy::bsdf}) {
    const Picture p = render(scene, independent_settings(64, 64, 128), with(strategy));
    EXPECT_TRUE(mean_is(mean_of(p, 0), 2 * 0.5 * 0.5, 0.015)) << int(strategy);
  }
}

// Lights without an area: no sample varies. Caught: candela taken as lumen, a cosine forgotten or
// doubled.
TEST(DirectLight, PointAndDirectionalLights) {
  Scene point;
  add_receiver(point, Rgb(0.5f, 0.5f, 0.5f));
  Light light;
  light.intensity = 10;
  add_light(point, light, translate({1, 2, 0}));
  for (const Strategy strategy : {Strategy::mis, Strategy::light, Strategy::bsdf})
    EXPECT_NEAR(mean_of(render(point, independent_settings(8, 8, 2), with(strategy)), 0).value, 0.284705,
                2e-4);

  Scene sun;
  add_receiver(sun, Rgb(0.2f, 0.5f, 0.8f));
  light.kind = LightKind::directional;
  light.color = {1, 0.5f, 0.25f};
  add_light(sun, light, look_along({0, 5, 0}, normalize(Vec3f(0.6f, -0.8f, 0))));
  const Picture p = render(sun, independent_settings(8, 8, 2));
  const double truths[] = {0.2 * 10, 0.5 * 5, 0.8 * 2.5};
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(mean_of(p, k).value, truths[k] * 0.8 / std::numbers::pi, 1e-5 * truths[k]) << k;
}

// glTF's range: a window that falls to zero there.
TEST(DirectLight, RangeEndsAPointLight) {
  for (const auto& [range, factor] : {std::pair{4.0f, 1 - std::pow(5.0 / 16, 2)}, std::pair{2.2f, 0.0}}) {
    Scene scene;
    add_receiver(scene, Rgb(0.5f, 0.5f, 0.5f));
    Light light;
    light.intensity = 10;
    light.range = range;
    add_light(scene, light, translate({1, 2, 0}));
    EXPECT_NEAR(mean_of(render(scene, independent_settings(4, 4, 1)), 0).value, 0.284705 * factor, 2e-4)
        << range;
  }
}

// All the light of a spot of 20 and 30 degrees on a plane: its flux. Caught: a smoothstep (.610), no
// square, full angles taken for half angles.
TEST(DirectLight, SpotFlux) {
  Scene scene;
  add_mesh(scene, make_quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}),
           add_material(scene, make_lambert({0.5f, 0.5f, 0.5f})));
  add_probe(scene, {0, 0, 0}, {0, 1, 0}, 0.1f, 0.6f);
  Light light;
  light.kind = LightKind::spot;
  light.inner_angle = kPi * 20 / 180;
  light.outer_angle = kPi * 30 / 180;
  add_light(scene, light, look_along({0, 1, 0}, {0, -1, 0}));
  const Mean mean = mean_of(render(scene, independent_settings(256, 256, 4)), 0);
  EXPECT_NEAR(mean.value * 1.2 * 1.2 * std::numbers::pi / 0.5, 0.533211, 0.0015);
}

/// An equirectangular image of f(direction), as scene.h lays it out.
template <class F>
Image environment_image(int width, int height, const F& f) {
  std::vector<float> texels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float theta = kPi * (float(y) + 0.5f) / float(height),
                  phi = 2 * kPi * ((float(x) + 0.5f) / float(width) - 0.5f);
      texels.push_back(
          f(Vec3f(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi))));
    }
  return make_image(width, height, 1, PixelType::f32, texels);
}

/// A plate in the origin that faces along `normal`, black from behind, and a probe of it.
Scene plate(const Vec3f& normal, float albedo) {
  Scene scene;
  const Frame frame = make_frame(normal);
  add_mesh(scene, make_quad({0, 0, 0}, frame.x, frame.y),
           add_material(scene, make_lambert(Rgb(albedo, albedo, albedo))));
  add_probe(scene, {0, 0, 0}, normal, 1, 0.1f);
  return scene;
}

// Plates in an environment of radiance 1 + w.a read albedo (1 + 2/3 n.a). Caught: an axis flipped or
// exchanged, the sine left out of the density, the rotation inverted.
TEST(Environment, GradientsLightPlatesFromTheirSide) {
  const Vec3f axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Quatf rotation;
  rotation.setAxisAngle(normalize(Vec3f(1, 2, 3)), 1);
  for (const Vec3f& axis : axes) {
    const Image image = environment_image(128, 64, [&](const Vec3f& w) { return 1 + w.dot(axis); });
    for (const Vec3f& n : axes)
      for (const float sign : {1.0f, -1.0f})
        for (const bool turn : {false, true}) {
          const Vec3f normal = turn ? rotation.rotateVector(n * sign) : n * sign;
          Scene scene = plate(normal, 0.6f);
          scene.images.push_back(image);
          scene.environment = {Rgb(1, 1, 1), 0, turn ? rotation : Quatf(1, 0, 0, 0)};
          const Picture p = render(scene, independent_settings(32, 32, 32));
          EXPECT_TRUE(mean_is(mean_of(p, 0), 0.6 * (1 + 2.0 / 3 * axis.dot(n) * sign), 0.03))
              << axis << n << sign << turn;
        }
  }
}

// The same by light sampling and BSDF sampling alone.
TEST(Environment, GradientByEitherStrategy) {
  Scene scene = plate({0, 1, 0}, 0.6f);
  scene.images.push_back(environment_image(128, 64, [](const Vec3f& w) { return 1 + w.y; }));
  scene.environment = {Rgb(1, 1, 1), 0, Quatf(1, 0, 0, 0)};
  for (const Strategy strategy : {Strategy::light, Strategy::bsdf}) {
    const Picture p = render(scene, independent_settings(64, 64, 128), with(strategy));
    EXPECT_TRUE(mean_is(mean_of(p, 0), 1, 0.006)) << int(strategy);
  }
}

// The background is the environment itself: the camera sees what lies in each direction.
TEST(Environment, IsSeenWhereItIs) {
  Scene scene;
  scene.images.push_back(
      environment_image(256, 128, [](const Vec3f& w) { return 2 + w.x + 0.5f * w.y + 0.25f * w.z; }));
  scene.environment = {Rgb(1, 0.5f, 0.25f), 0, Quatf(1, 0, 0, 0)};
  for (const Vec3f& d : {Vec3f(1, 0, 0), Vec3f(-1, 0, 0), Vec3f(0, 0, 1), Vec3f(0, 0, -1),
                         Vec3f(0.6f, 0.8f, 0), Vec3f(0, -0.8f, 0.6f)}) {
    Scene view = scene;
    add_eye(view, {0, 0, 0}, d, 1e-3f);
    const Picture p = render(view, independent_settings(2, 2, 1));
    EXPECT_NEAR(p.at(0, 0)[0], 2 + d.x + 0.5f * d.y + 0.25f * d.z, 2e-3) << d;
    EXPECT_NEAR(p.at(0, 0)[2], 0.25f * p.at(0, 0)[0], 1e-5);
  }
}

// A sun of one texel, 1e5 times as bright as the sky, on a plate: against an integral of the bilinear
// lookup. Caught: a density that knows the texel but not what the lookup spreads to its neighbours, or that
// lacks the sine.
TEST(Environment, SunOfOneTexel) {
  constexpr int kWidth = 64, kHeight = 32, kSunX = 20, kSunY = 9;
  std::vector<float> texels(kWidth * kHeight, 1);
  texels[kSunY * kWidth + kSunX] = 1e5f;
  Scene scene = plate({0, 1, 0}, 0.5f);
  scene.images.push_back(make_image(kWidth, kHeight, 1, PixelType::f32, texels));
  scene.environment = {Rgb(1, 1, 1), 0, Quatf(1, 0, 0, 0)};

  // Radiance 1 everywhere, and a tent of height 1e5 - 1 over the sun's texel.
  double sun = 0;
  constexpr int kSteps = 400;
  for (int j = 0; j < 2 * kSteps; ++j) {
    const double y = -1 + (j + 0.5) / kSteps, theta = std::numbers::pi * (kSunY + 0.5 + y) / kHeight;
    sun += (1 - std::abs(y)) * std::sin(theta) * std::cos(theta) / kSteps;
  }
  sun *= (1e5 - 1) * (2 * std::numbers::pi / kWidth) * (std::numbers::pi / kHeight);
  const Picture p = render(scene, independent_settings(64, 64, 64));
  EXPECT_TRUE(mean_is(mean_of(p, 0), 0.5 * (1 + sun / std::numbers::pi), 0.01));
}

}  // namespace
}  // namespace parian
