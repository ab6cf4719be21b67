/// Samples and weights.
#include "renderer/base/distribution.h"
#include "renderer/base/sampling.h"
#include "renderer/light/light_table.h"
#include "renderer/shapes/sphere.h"
#include "tests/bench/material_stability/report.h"
#include "tests/bench/material_stability/textbook.h"
#include "tests/support/scenes.h"

namespace parian {
namespace {

void compare_weights() {
  TestRandom random(9);
  Largest naive, parian;
  for (int i = 0; i < kTries; ++i) {
    const float a = between(random, 1e-30, 1e30), b = a * between(random, 1e-4, 1e4);
    const Real truth = textbook_power_heuristic<Real>(a, b);
    naive.add(double(textbook_power_heuristic(a, b) - truth));
    parian.add(double(power_heuristic(a, b) - truth));
  }
  print_row("power heuristic", "densities 1e-30 to 1e30", "`a*a / (a*a + b*b)`", naive.text(), parian.text());
}

void compare_numbers() {
  int ones[2] = {0, 0};
  constexpr int kLast = 1000;
  for (std::uint32_t i = 0; i < kLast; ++i) {
    const std::uint32_t x = 0xffffffffu - i;
    ones[0] += float(x) * 0x1p-32f >= 1;
    ones[1] += to_unit_float(x) >= 1;
  }
  print_row("random numbers in [0, 1) that are 1", "of 2^32", "`x * 2^-32`", fmt::format("{}", ones[0]),
            fmt::format("{}", ones[1]));
}

void compare_cosine_hemisphere() {
  TestRandom random(10);
  Largest naive, parian;
  for (int i = 0; i < kTries; ++i) {
    const float u = 1 - float(1 + i % 1000) * 0x1p-24f, v = random.next1();
    const double truth = std::sqrt(1 - double(u));
    const Vec2f p = unit_circle(v) * std::sqrt(u);
    naive.add(std::sqrt(1 - p.x * p.x - p.y * p.y) / truth - 1);
    parian.add(sample_cosine_hemisphere({u, v}).z / truth - 1);
  }
  print_row("cosine of a cosine-distributed direction, relative", "the last 1000 numbers below 1",
            "`sqrt(1 - x*x - y*y)`", naive.text(), parian.text());
}

void compare_sphere_light() {
  for (const float distance : {0.5f, 1e2f, 1e3f, 1e4f}) {
    Largest naive, parian;
    const Real ratio = 1 / Real(distance), sine2 = ratio * ratio;
    const Real truth =
        distance < 1 ? 1 / (4 * pi<Real>) : (1 + std::sqrt(1 - sine2)) / (2 * pi<Real> * sine2);
    naive.add(double(textbook_cone_pdf(1.0f, distance) / truth - 1));
    parian.add(double(pdf_directions({0, 0, 0}, 1, {0, 0, distance}) / truth - 1));
    print_row("density of directions to a sphere, relative",
              fmt::format("{} radii from its centre", number(distance)), "`1 - sqrt(1 - sq(R / d))`",
              naive.text(), parian.text());
  }
}

/// A ball of triangles with those at the poles that have no area, as a light.
void compare_degenerate_lights() {
  constexpr int kRings = 8;
  Primitive ball = make_uv_sphere({0, 0, 0}, 1, kRings);
  std::vector<Triangle> triangles(ball.triangles.begin(), ball.triangles.end());
  for (std::uint32_t i = 0; i < 2 * kRings; ++i) {
    const std::uint32_t bottom = kRings * (2 * kRings + 1) + i;
    triangles.push_back({i, i + 1, i});
    triangles.push_back({i, i + 1, i + 2 * kRings + 2});
    triangles.push_back({bottom - 2 * kRings - 1, bottom + 1, bottom});
  }
  ball.triangles = triangles;

  const Vec3f p(3, 2, 1);
  TestRandom random(11);
  int broken[2] = {0, 0};
  for (int i = 0; i < kTries; ++i) {
    const Triangle& t = triangles[std::size_t(random.next1() * float(triangles.size()))];
    const Vec2f b = sample_triangle(random.next2());
    const Vec3f a = ball.positions[t[0]], e1 = ball.positions[t[1]] - a, e2 = ball.positions[t[2]] - a;
    const Vec3f cross = e1.cross(e2), to_light = a + e1 * b.x + e2 * b.y - p;
    const float cosine = std::abs(normalize(to_light).dot(normalize(cross)));
    broken[0] += !std::isfinite(to_light.length2() / (0.5f * cross.length() * cosine));
  }
  Scene scene;
  Material emitter = make_emitter(Rgb(1));
  emitter.double_sided = true;
  add_mesh(scene, std::move(ball), add_material(scene, emitter));
  const World world = make_world(scene);
  const LightTable lights(scene, world);
  for (int i = 0; i < kTries; ++i) {
    Sampler sampler(SamplerKind::independent, 1, 0, 0, std::uint32_t(i));
    const Vec2f u = sampler.next2();
    const auto s = lights.sample({p, {0, 0, 0}}, u, sampler);
    broken[1] += s && !(is_finite(s->wi) && std::isfinite(s->pdf) && s->pdf > 0);
  }
  print_row("light samples that are not finite", "a ball with the triangles at its poles",
            "`d*d / (area * cos)`, any triangle", percent(double(broken[0]) / kTries),
            percent(double(broken[1]) / kTries));
}

void compare_sums() {
  const std::vector<float> texels(std::size_t(1) << 24, 0.1f);
  float sum = 0;
  for (const float x : texels) sum += x;
  const double truth = double(0.1f) * double(texels.size());
  print_row("power of an environment, relative", "2^24 texels of .1", "summed in float",
            number(sum / truth - 1), number(Distribution1D(texels).total() / truth - 1));
}

}  // namespace

void compare_samples() {
  print_head("samples and weights");
  compare_weights();
  compare_numbers();
  compare_cosine_hemisphere();
  compare_sphere_light();
  compare_degenerate_lights();
  compare_sums();
}

}  // namespace parian
