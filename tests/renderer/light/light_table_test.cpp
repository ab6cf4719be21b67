#include "renderer/light/light_table.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/renderer/light/support/lit_scene.h"
#include "tests/support/chi_square.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

constexpr double kPiD = std::numbers::pi;

/// Calls visit(radiance, pdf) for each light of the scene that the ray from a receiver along d meets, hidden
/// or not: by brute force in double, without the accelerator.
void for_each_light_on_ray(const LitScene& lit, const Receiver& to, const Vec3f& d,
                           const std::function<void(const Rgb&, float)>& visit) {
  const World& world = lit.world;
  const Vec3f& p = to.p;
  // (t, u, v) of the ray in the frame of origin, e1 and e2.
  const auto intersect = [&](const Vec3d& origin, const Vec3d& e1, const Vec3d& e2) -> std::optional<Vec3d> {
    const Vec3d o = Vec3d(p) - origin, w(d), n = e1.cross(e2);
    const double det = -w.dot(n);
    if (det == 0) return std::nullopt;
    const double t = o.dot(n) / det;
    const Vec3d q = o + w * t;
    if (t <= 0) return std::nullopt;
    return Vec3d(t, q.cross(e2).dot(n) / n.dot(n), e1.cross(q).dot(n) / n.dot(n));
  };
  for (std::uint32_t k = 0; k < world.placements.size(); ++k) {
    const Placement& placement = world.placements[k];
    for (std::uint32_t i = 0; i < lit.scene.meshes[placement.mesh].primitives.size(); ++i) {
      const Part& part = world.part(k, i);
      for (std::uint32_t j = 0; part.emissive && j < part.primitive->triangles.size(); ++j) {
        const Triangle& t = part.primitive->triangles[j];
        const auto vertex = [&](int c) { return placement.to_world.point(part.primitive->positions[t[c]]); };
        const Vec3f v0 = vertex(0), e1 = vertex(1) - v0, e2 = vertex(2) - v0;
        const auto hit = intersect(Vec3d(v0), Vec3d(e1), Vec3d(e2));
        if (!hit || hit->y < 0 || hit->z < 0 || hit->y + hit->z > 1) continue;
        Vec3f n = e1.cross(e2).normalized();
        if (placement.to_world.determinant() < 0) n = -n;
        if (!part.material->double_sided && d.dot(n) >= 0) continue;
        const auto uvs = interpolate_uvs(*part.primitive, t, float(hit->y), float(hit->z));
        visit(eval_emission(lit.scene, *part.material, uvs, std::abs(d.dot(n))),
              lit.table.pdf_triangle({float(hit->x), float(hit->y), float(hit->z), k, i, j}, to,
                                     std::abs(d.dot(n))));
      }
    }
  }
  for (std::uint32_t k = 0; k < world.area_lights.size(); ++k) {
    const AreaLight& light = world.area_lights[k];
    const auto hit = intersect(Vec3d(light.center), Vec3d(light.half_x), Vec3d(light.half_y));
    if (!hit || d.dot(light.normal) >= 0) continue;
    if (light.disk ? hit->y * hit->y + hit->z * hit->z > 1 : std::max(std::abs(hit->y), std::abs(hit->z)) > 1)
      continue;
    visit(light.radiance, lit.table.pdf_area_light({float(hit->x), 0, 0, Hit::kAreaLightHit, 0, k}, to,
                                                   -d.dot(light.normal)));
  }
  if (lit.table.environment().black()) return;
  const EnvironmentSample sky = lit.table.look_up_environment(d, to);
  visit(sky.radiance, sky.pdf);
}

float pdf_on_ray(const LitScene& lit, const Vec3f& p, const Vec3f& d) {
  float sum = 0;
  for_each_light_on_ray(lit, {p, Vec3f(0)}, d, [&](const Rgb&, float pdf) { sum += pdf; });
  return sum;
}

// --- Densities ---

// The directions that sample() draws follow the sum of the densities that pdf_...() state of all
// lights behind one another; catches area densities that are not converted, a choice that is not in, and
// lights numbered wrongly.
void expect_density(const Scene& scene, const Vec3f& p, const Vec3f& towards, const char* name) {
  const LitScene lit(scene);
  std::uint32_t i = 0;
  const auto draw = [&]() -> std::optional<Vec3f> {
    const auto s = sample(lit, p, i++);
    if (!s || s->delta) return std::nullopt;
    return s->wi;
  };
  const SphereCells cells{.axis = normalize(towards),
                          .zoom = 0.1,
                          .rings = 20,
                          .sectors = 12,
                          .tolerance = 1e-6,
                          .depth = lit.table.size() > 50 ? 5 : 7};
  EXPECT_TRUE(samples_directions(
      draw, [&](const Vec3f& d) { return pdf_on_ray(lit, p, d); }, cells, 100000, 10))
      << name;
}

TEST(LightTable, SamplesATriangleWithItsDensity) {
  Scene scene;
  const int emitter = add_material(scene, make_emitter({1, 1, 1}));
  add_mesh(scene, make_triangle({-1, 2, -1}, {2, 1.5f, -1}, {0, 2, 3}), emitter, scale({1, 1, -1.5f}));
  expect_density(scene, {0.3f, 0, 0}, {0, 1, 0}, "front of a mirrored triangle");
  scene.nodes[0].transform.scale.z = 1.5f;
  scene.materials[0].double_sided = true;
  expect_density(scene, {0.3f, 0, 0}, {0, 1, 0}, "back of a two-sided triangle");
}

TEST(LightTable, SamplesAreaLightsWithTheirDensity) {
  Scene rectangular, round;
  add_light(rectangular, rectangle(1, 3), look_along({0.5f, 1, 0}, normalize(Vec3f(0.2f, -1, 0.3f))));
  expect_density(rectangular, {0, 0, 0}, {0.3f, 1, 0}, "rectangle");
  Transform tilted = look_along({0.5f, 1, 0}, normalize(Vec3f(0.2f, -1, 0.3f)));
  add_light(round, disk(2), tilted);
  expect_density(round, {0, 0, 0}, {0.3f, 1, 0}, "disk");
}

/// Emitting primitives behind one that does not, instanced twice; area lights; a punctual light; a sky.
Scene make_full_scene() {
  Scene scene;
  const int dark = add_material(scene, make_lambert({0.5f, 0.5f, 0.5f}));
  const int warm = add_material(scene, make_emitter({3, 2, 1})),
            faint = add_material(scene, make_emitter({1, 1, 1}));
  Primitive floor = make_quad({0, -2, 0}, {3, 0, 0}, {0, 0, -3}),
            box = make_box({-0.4f, 0, -0.3f}, {0.4f, 1, 0.5f}),
            tip = make_triangle({-0.5f, 1.5f, 0}, {0.5f, 1.5f, 0}, {0, 1.5f, -0.7f});
  floor.material = dark;
  box.material = warm;
  tip.material = faint;
  scene.meshes.push_back({"", {floor, box, tip}});
  Node node;
  node.mesh = 0;
  Transform mirrored = translate({-1, 1, -2});
  mirrored.scale = {-1, 2, 0.5f};
  node.instances = instances({translate({2, 0.5f, 0}), mirrored});
  add_root(scene, node);
  add_mesh(scene, make_quad({0, -2, 0}, {3, 0, 0}, {0, 0, -3}), dark);
  add_light(scene, rectangle(1, 2, 2), look_along({0, 1, 2}, {0, -0.6f, -0.8f}));
  add_light(scene, disk(1.5f, 3), above(3));
  add_light(scene, make_light(LightKind::point, 2), translate({0, 2, 0}));
  scene.environment.radiance = {0.1f, 0.1f, 0.1f};
  return scene;
}

TEST(LightTable, SamplesAllLightsTogetherWithTheirDensity) {
  expect_density(make_full_scene(), {0.2f, 0, 0.3f}, {1, 1, 0}, "all");
}

// More lights than one random number can choose among and be used again for the point.
TEST(LightTable, SamplesManyLightsWithTheirDensity) {
  Scene scene;
  const int emitter = add_material(scene, make_emitter({1, 1, 1}));
  for (int i = 0; i < 6; ++i)
    add_mesh(scene, make_box({-0.2f, -0.2f, -0.2f}, {0.2f, 0.3f, 0.2f}), emitter,
             translate({float(i % 3) - 1, 1.5f, float(i / 3) - 1}));
  EXPECT_EQ(LitScene(scene).table.size(), 72);
  expect_density(scene, {0.1f, 0, 0}, {0, 1, 0}, "72 triangles");
}

TEST(LightTable, AnEnvironmentImageKeepsItsDensityAmongOtherLights) {
  Scene scene = make_full_scene();
  std::vector<float> texels;
  for (int i = 0; i < 8 * 4; ++i) texels.push_back(float(i * i % 7));
  scene.images.push_back(make_image(8, 4, 1, PixelType::f32, texels));
  scene.environment.image = 0;
  expect_density(scene, {0.2f, 0, 0.3f}, {1, 1, 0}, "sky");
}

// What a sample says of its own point is what a ray there finds: density, radiance; and the shadow ray's end
// lies before the light.
TEST(LightTable, SamplesAgreeWithTheRayThatFollowsThem) {
  Scene scene = make_full_scene();
  scene.materials.push_back(make_emitter({1, 2, 3}));
  Primitive textured = make_quad({0, 4, 0}, {0, 0, 1}, {1, 0, 0});
  scene.materials.back().emission_texture =
      add_texture(scene, make_image<float>(2, 2, 1, PixelType::f32, {1, 2, 3, 4}));
  add_mesh(scene, textured, int(scene.materials.size()) - 1);
  const LitScene lit(scene);
  const Vec3f p(0.2f, -0.5f, 0.3f);
  for (const Vec3f& n : {Vec3f(0), normalize(Vec3f(1, 2, -0.5f))}) {
    int found = 0, compared = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
      Sampler sampler(SamplerKind::independent, 1, 0, 0, i);
      const Vec2f u = sampler.next2();
      const auto s = lit.table.sample({p, n}, u, sampler);
      if (!s || s->delta) continue;
      ++compared;
      EXPECT_NEAR(s->wi.length(), 1, 1e-5);
      bool match = false;
      for_each_light_on_ray(lit, {p, n}, s->wi, [&](const Rgb& radiance, float pdf) {
        match |= std::abs(pdf - s->pdf) < 1e-3f * pdf &&
                 (radiance - s->radiance).length() < 1e-3f * radiance.length();
      });
      found += match;
      if (s->at_infinity) continue;
      const Vec3f to_target = s->target - p;
      EXPECT_LT((to_target - s->wi * to_target.dot(s->wi)).length(), 1e-4f * to_target.length());
    }
    EXPECT_GT(compared, 10000);
    EXPECT_GT(found, 0.999 * compared) << "an edge may round away";
  }
}

TEST(LightTable, ShadowRaysEndBeforeTheLight) {
  Scene scene;
  const int emitter = add_material(scene, make_emitter({1, 1, 1}));
  scene.materials[0].double_sided = true;
  add_mesh(scene, make_quad({1e4f, 5, 0}, {0, 0, 1}, {1, 0, 0}), emitter);
  const LitScene lit(scene);
  for (const float side : {-1.0f, 1.0f})
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const Vec3f p(1e4f, 5 + 3 * side, 0);
      const auto s = sample(lit, p, i);
      ASSERT_TRUE(s);
      const float gap = (s->target.y - 5) * side;
      ASSERT_TRUE(gap > 0 && gap < 0.1f) << gap;
    }
}

// --- Choice ---

// Powers: two-sided triangle 2 pi A L, rectangle pi A L, disk pi A L, point 4 pi I: 4 pi each, but the last
// 12 pi. Each light at a height of its own. The densities are checked against the choice elsewhere.
TEST(LightTable, ChoosesInProportionToPower) {
  Scene scene;
  const int emitter = add_material(scene, make_emitter({1, 1, 1}));
  scene.materials[0].double_sided = true;
  add_mesh(scene, make_triangle({0, 4, 0}, {2, 4, 0}, {0, 4, 2}), emitter);
  add_light(scene, rectangle(2, 2), above(5));
  add_light(scene, disk(2, 4 / kPi), above(6));
  add_light(scene, make_light(LightKind::point, 1), translate({0, 7, 0}));
  add_light(scene, make_light(LightKind::point, 3), translate({0, 8, 0}));
  const LitScene lit(scene, LightChoice::power);
  ASSERT_EQ(lit.table.size(), 5);
  std::vector<double> observed(5, 0);
  for (std::uint32_t i = 0; i < 70000; ++i) {
    const auto s = sample(lit, {0.1f, 0, 0.1f}, i);
    ASSERT_TRUE(s);
    const int light = int(std::lround(s->target.y)) - 4;
    ++observed.at(light);
    if (s->delta) {
      ASSERT_NEAR(s->pdf, light == 4 ? 3.0 / 7 : 1.0 / 7, 1e-6);
    }
  }
  EXPECT_TRUE(chi_square(observed, std::vector<double>{1e4, 1e4, 1e4, 1e4, 3e4}));
}

TEST(LightTable, WeighsTheSkyBySizeOfTheScene) {
  Scene scene;
  add_mesh(scene, make_box({-3, -4, 0}, {3, 4, 0}), add_material(scene, make_lambert({1, 1, 1})));
  scene.environment.radiance = {1, 1, 1};
  add_light(scene, make_light(LightKind::directional, 4 * kPi), {});
  add_light(scene, make_light(LightKind::point, 25 * kPi), {});
  const LitScene lit(scene);
  // Radius 5: sky 4 pi^2 25, directional 4 pi pi 25, point 4 pi 25 pi.
  EXPECT_NEAR(lit.table.look_up_environment({0, 1, 0}, {Vec3f(0), Vec3f(0)}).pdf, 1 / (4 * kPiD) / 3, 1e-6);
}

// --- Degenerate lights ---

void expect_finite(const Scene& scene, const std::vector<Vec3f>& points, const char* name) {
  const LitScene lit(scene);
  for (const Vec3f& p : points)
    for (std::uint32_t i = 0; i < 2000; ++i) {
      const auto s = sample(lit, p, i);
      if (!s) continue;
      ASSERT_TRUE(is_finite(s->wi) && is_finite(s->target) && is_finite(s->radiance)) << name;
      ASSERT_TRUE(s->pdf > 0 && s->pdf < kInfinity) << name;
      const Vec3f contribution = s->radiance * (1 / s->pdf);
      ASSERT_TRUE(is_finite(contribution) && contribution.x >= 0) << name;
    }
}

TEST(LightTable, OfADarkSceneIsEmpty) {
  Scene scene;
  add_mesh(scene, make_box({-1, -1, -1}, {1, 1, 1}), add_material(scene, make_lambert({1, 1, 1})));
  EXPECT_TRUE(LitScene(scene).table.empty());
  EXPECT_TRUE(LightTable().empty());
  EXPECT_TRUE(LitScene(Scene{}).table.empty());
}

TEST(LightTable, UnlitMaterialsAreNoLights) {
  Scene scene;
  Material unlit = make_emitter({1, 1, 1});
  unlit.unlit = true;
  add_mesh(scene, make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), add_material(scene, unlit));
  EXPECT_TRUE(LitScene(scene).table.empty());
}

TEST(LightTable, LightsOfNoAreaAreHarmless) {
  Scene scene;
  const int emitter = add_material(scene, make_emitter({1, 1, 1}));
  add_mesh(scene, make_triangle({0, 1, 0}, {1, 1, 0}, {2, 1, 0}), emitter);
  expect_finite(scene, {{0, 0, 0}, {0, 1, 0}}, "one triangle");
  add_mesh(scene, make_triangle({0, 1, 0}, {0, 1, 0}, {0, 1, 0}), emitter);
  expect_finite(scene, {{0, 0, 0}, {0, 1, 0}}, "two triangles");
  add_mesh(scene, make_triangle({0, 1, 0}, {1e-25f, 1, 0}, {0, 1, 1e-25f}), emitter);
  expect_finite(scene, {{0, 0, 0}, {0, 1, 0}}, "and a tiny one");
  add_mesh(scene, make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), emitter);
  expect_finite(scene, {{0, 0, 0}, {0, 1, 0}}, "beside one that shines");
  // They are not chosen: the quad alone lights.
  expect_irradiance(scene, {0, 1, 0}, kPiD * 0.554126);
}

TEST(LightTable, LightsWithoutPowerAreHarmless) {
  Scene scene;
  add_light(scene, make_light(LightKind::point, 0));
  add_light(scene, rectangle(1, 1, 0), above(2));
  add_light(scene, make_light(LightKind::directional, 0));
  expect_finite(scene, {{0, 0, 0}, {0, 1, 0}}, "no power at all");
  const LitScene lit(scene);
  for (std::uint32_t i = 0; i < 100; ++i) {
    const auto s = sample(lit, {0.5f, 0, 0}, i);
    if (s) {
      EXPECT_TRUE(is_black(s->radiance));
    }
  }
}

TEST(LightTable, LightsThatTouchTheirReceiverAreHarmless) {
  Scene scene;
  const int emitter = add_material(scene, make_emitter({1, 1, 1}));
  scene.materials[0].double_sided = true;
  add_mesh(scene, make_quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}), emitter);
  add_light(scene, rectangle(1, 1), above(0));
  add_light(scene, disk(1), above(0));
  add_light(scene, make_light(LightKind::point, 1));
  add_light(scene, make_light(LightKind::spot, 1));
  const std::vector<Vec3f> touching{{0, 0, 0},      {1, 0, 1},       {0.3f, 0, 0.2f}, {5, 0, 0},
                                    {0, 1e-20f, 0}, {0, -1e-38f, 0}, {0, 1e-6f, 0}};
  expect_finite(scene, touching, "touching");
}

TEST(LightTable, SeesNothingFromBehindOrEdgeOn) {
  Scene area, mesh;
  add_light(area, rectangle(1, 1), above(1));
  const int emitter = add_material(mesh, make_emitter({1, 1, 1}));
  add_mesh(mesh, make_quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}), emitter);
  for (const Scene& scene : {area, mesh}) {
    const LitScene lit(scene);
    for (std::uint32_t i = 0; i < 100; ++i) {
      EXPECT_TRUE(sample(lit, {0, 0, 0}, i));
      EXPECT_FALSE(sample(lit, {0, 3, 0}, i)) << "from behind";
      EXPECT_FALSE(sample(lit, {5, 1, 0}, i)) << "edge on";
    }
  }
}

TEST(LightTable, HugeAndTinyLightsStayFinite) {
  for (const float size : {1e-6f, 1e6f})
    for (const float radiance : {1e-20f, 1e20f}) {
      Scene scene;
      const int emitter = add_material(scene, make_emitter(Rgb(radiance)));
      add_mesh(scene, make_quad({0, size, 0}, {size, 0, 0}, {0, 0, size}), emitter);
      add_light(scene, rectangle(2 * size, 2 * size, radiance), above(size));
      expect_finite(scene, {{0, 0, 0}, {size, 0.5f * size, 0}}, "scaled");
      expect_irradiance(scene, {0, 1, 0}, 2 * kPiD * double(radiance) * 0.554126, 0.01);
    }
}

}  // namespace
}  // namespace parian
