/// Media, and pictures through them.
#include "integrators/boundary.h"
#include "tests/bench/material_stability/report.h"
#include "tests/bench/material_stability/textbook.h"
#include "tests/integrators/support/render.h"
#include "tests/integrators/support/shapes.h"

namespace parian {
namespace {

void compare_transmittance() {
  Largest coloured[2], black[2];
  for (const float color : {0.0f, 1e-30f, 1e-3f, 0.5f, 1.0f})
    for (const float distance : {0.0f, 1e-6f, 1e-3f, 1.0f, 1e6f, kInfinity}) {
      const Real truth = color == 1 || distance == 0 ? 1
                         : color == 0 || distance == kInfinity
                             ? 0
                             : std::exp(std::log(Real(color)) * Real(distance));
      Material m = make_lambert(Rgb(0));
      m.volume.emplace();
      m.volume->thickness = m.volume->attenuation_distance = 1;
      m.volume->attenuation_color = Rgb(color);
      const Medium medium = make_medium(m);
      Largest* const largest = color == 0 ? black : coloured;
      largest[0].add(double(textbook_transmittance(color, distance) - truth));
      largest[1].add(double(transmittance(&medium, distance).x - truth));
    }
  const char* const form = "`exp(log(color) * d)`";
  print_row("transmittance", "colours 1e-30 to 1, distances 0 to infinity", form, coloured[0].text(),
            coloured[1].text());
  print_row("transmittance", "colour 0", form, black[0].text(), black[1].text());
}

Material make_glass(float ior, int priority = 0) {
  Material m;
  m.metallic = m.roughness = 0;
  m.ior = ior;
  m.priority = priority;
  m.transmission.emplace();
  m.transmission->factor = 1;
  m.volume.emplace();
  m.volume->thickness = 1;
  return m;
}

std::string probe(const Scene& scene, std::uint32_t seed, std::uint32_t spp, int max_depth = 100) {
  const Mean mean =
      mean_of(render(scene, independent_settings(16, 16, spp, seed), with(Strategy::bsdf, max_depth)), 0);
  return fmt::format("{:.5f} +- {:.0e}", mean.value, mean.error);
}

double reflectance(double n1, double n2) { return (n1 - n2) * (n1 - n2) / ((n1 + n2) * (n1 + n2)); }

void compare_radiance_scaling() {
  Scene emitter;
  add_shape(emitter, make_sphere(2), add_material(emitter, make_glass(1.5f)));
  add_shape(emitter, make_sphere(1), add_material(emitter, make_emitter(Rgb(1))));
  add_probe(emitter, {0, 0, 0}, {0, 0, 1}, 5, 1e-3f);
  const double t = 1 - reflectance(1, 1.5);
  print_row(fmt::format("radiance of an emitter in glass, true: {:.5f}", t / 2.25), "index 1.5, head on",
            "`1 - F` at the interface", fmt::format("{:.5f}", t), probe(emitter, 1, 2048));
  Scene camera;
  add_mesh(camera, make_box({-40, -5, -40}, {40, 5, 40}), add_material(camera, make_glass(1.5f)));
  camera.environment.radiance = Rgb(1, 1, 1);
  add_probe(camera, {0, 0, 0}, {0, -1, 0}, 1, 1e-3f);
  print_row(fmt::format("a sky of 1 from inside glass, true: {:.5f}", t * 2.25), "index 1.5, head on",
            "`1 - F` at the interface", fmt::format("{:.5f}", t), probe(camera, 2, 8192, 1));
}

/// Glass on water that emits at its bottom; `gap` of air between.
Scene glass_on_water(float gap) {
  Scene scene;
  add_mesh(scene, make_box({-40, 0, -40}, {40, 1, 40}), add_material(scene, make_glass(1.5f, 1)));
  add_mesh(scene, make_box({-40, -1, -40}, {40, -gap, 40}), add_material(scene, make_glass(1.33f)));
  add_mesh(scene, make_quad({0, -0.5f, 0}, {30, 0, 0}, {0, 0, -30}),
           add_material(scene, make_emitter({1, 1, 1})));
  add_probe(scene, {0, 1, 0}, {0, 1, 0}, 3, 1e-3f);
  return scene;
}

void compare_contact() {
  const double r1 = reflectance(1, 1.5), r2 = reflectance(1.5, 1.33);
  const double truth = (1 - r1) * (1 - r2) / (1 - r1 * r2) / (1.33 * 1.33);
  print_row(fmt::format("radiance of an emitter in water under glass, true: {:.5f}", truth),
            "the two in one place", "one boundary after the other (a gap of .01)",
            probe(glass_on_water(0.01f), 3, 2048), probe(glass_on_water(0), 4, 2048));
}

void compare_roulette() {
  // Weights of survivors that do not make up for the others: the n-th bounce counts with rho^n times the
  // probability of getting there.
  double naive = 0, reached = 1;
  for (int n = 0; n < 100; ++n) {
    naive += std::pow(0.9, n) * reached;
    reached *= std::pow(0.9, n + 1);
  }
  Scene scene;
  Material wall = make_lambert(Rgb(0.9f));
  wall.emission = Rgb(1);
  add_mesh(scene, make_box({-1, -1, -1}, {1, 1, 1}, false), add_material(scene, wall));
  add_eye(scene, {0.1f, 0.2f, 0.3f}, {1, 0.3f, 0.2f}, 1);
  print_row("radiance in a furnace of albedo .9, true: 10", "roulette by weight",
            "survivors' weights not divided", number(naive), probe(scene, 5, 4096, 1000));
}

struct Terminator {
  double deviation = 0, black = 0;
  std::string text() const { return fmt::format("{:.1f}%, {:.1f}%", 100 * deviation, 100 * black); }
};

/// A ball lit from the side: the pixels of a mesh of it against those of the ball itself.
Terminator compare_pixels(const std::function<double(int, int)>& mesh, const Picture& ball) {
  Terminator t;
  double sum = 0;
  for (int y = 0; y < ball.height; ++y)
    for (int x = 0; x < ball.width; ++x) {
      const double truth = ball.at(x, y)[0], value = mesh(x, y);
      sum += truth;
      t.deviation += std::abs(value - truth);
      t.black += (truth > 0.1 && value < 0.01) / double(ball.width * ball.height);
    }
  t.deviation /= sum;
  return t;
}

void compare_terminator() {
  const Vec3f sun_direction = normalize(Vec3f(-1, -0.2f, -0.1f));
  constexpr int kSize = 96, kSpp = 16;
  constexpr float kHalf = 0.6f;
  for (const int rings : {6, 12}) {
    const auto make_scene = [&](bool mesh) {
      Scene scene;
      const int white = add_material(scene, make_lambert({1, 1, 1}));
      if (mesh)
        add_mesh(scene, make_uv_sphere({0, 0, 0}, 1, rings), white);
      else
        add_shape(scene, make_sphere(1), white);
      Light sun;
      sun.kind = LightKind::directional;
      sun.intensity = kPi;
      add_light(scene, sun, look_along({0, 0, 0}, sun_direction));
      add_probe(scene, {0, 0, 0}, {0, 0, 1}, 3, kHalf);
      return scene;
    };
    const auto settings = independent_settings(kSize, kSize, kSpp);
    const Scene scene = make_scene(true);
    const Picture ball = render(make_scene(false), settings, with(Strategy::mis, 1)),
                  mesh = render(scene, settings, with(Strategy::mis, 1));
    // Lit where both normals say so: the ball is convex, nothing else is in the way.
    const World world = make_world(scene);
    const Accel accel(scene, world, AccelSettings{});
    TestRandom random(13);
    const auto naive = [&](int x, int y) {
      double value = 0;
      for (int i = 0; i < kSpp; ++i) {
        const Vec2f p = (Vec2f(float(x), float(y)) + random.next2()) * (2 * kHalf / kSize);
        const Ray ray{{p.x - kHalf, kHalf - p.y, 3}, {0, 0, -1}};
        Hit hit;
        if (!accel.intersect(ray, 0, hit)) continue;
        const Surface s = make_surface(scene, world, hit, ray.d);
        if (s.ng.dot(sun_direction) < 0) value -= std::min(0.0f, s.frame.z.dot(sun_direction)) / kSpp;
      }
      return value;
    };
    print_row("deviation from a ball, share that is black and should not be",
              fmt::format("{} rings of quads, lit from the side", rings), "shadow rays from the triangles",
              compare_pixels(naive, ball).text(),
              compare_pixels([&](int x, int y) { return mesh.at(x, y)[0]; }, ball).text());
  }
}

}  // namespace

void compare_media() {
  print_head("media and pictures");
  compare_transmittance();
  compare_radiance_scaling();
  compare_contact();
  compare_roulette();
  compare_terminator();
}

}  // namespace parian
