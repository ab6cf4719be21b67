// Pictures of every material extension: light found by sampling lights, directions, or both is the same
// light; and surfaces that lose nothing are invisible in a furnace.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "tests/integrators/support/render.h"
#include "tests/integrators/support/shapes.h"
#include "tests/support/block_test.h"

namespace parian {
namespace {

struct Named {
  const char* name;
  Material material;
};

Material make_base(float metallic, float roughness) {
  Material m;
  m.base_color = {0.8f, 0.5f, 0.3f};
  m.metallic = metallic;
  m.roughness = roughness;
  return m;
}

Material make_rough_glass(float roughness, bool thin) {
  Material m = make_base(0, roughness);
  m.base_color = {1, 0.9f, 0.8f};
  m.transmission = Transmission{.factor = 1, .texture = {}};
  if (!thin)
    m.volume = Volume{.thickness = 1, .attenuation_color = {0.5f, 0.7f, 0.9f}, .attenuation_distance = 1};
  return m;
}

/// Each extension on a base, and all that go together. All lobes are wide enough for samples of lights to
/// find them.
std::vector<Named> materials() {
  std::vector<Named> all;
  const auto add = [&](const char* name, Material base, const std::function<void(Material&)>& change = {}) {
    if (change) change(base);
    all.push_back({name, std::move(base)});
  };
  const auto coat = [](Material& m) {
    m.clearcoat.emplace().factor = 1;
    m.clearcoat->roughness = 0.5f;
  };
  const auto cloth = [](Material& m) {
    m.sheen.emplace().color = {0.9f, 0.6f, 0.4f};
    m.sheen->roughness = 0.4f;
  };
  const auto brushed = [](Material& m) {
    m.anisotropy.emplace().strength = 0.7f;
    m.anisotropy->rotation = 0.5f;
  };
  const auto film = [](Material& m) {
    m.iridescence.emplace().factor = 1;
    m.iridescence->ior = 1.8f;
    m.iridescence->thickness_maximum = 300;
  };
  const auto paper = [](Material& m) {
    m.diffuse_transmission.emplace().factor = 0.6f;
    m.diffuse_transmission->color = {0.4f, 0.9f, 0.5f};
  };
  add("MetallicRoughness", make_base(0.5f, 0.5f));
  add("Specular", make_base(0, 0.5f), [](Material& m) {
    m.ior = 2.2f;
    m.specular = 0.8f;
    m.specular_color = {1, 0.5f, 0.2f};
  });
  add("Clearcoat", make_base(0.5f, 0.7f), coat);
  add("Sheen", make_base(0, 0.7f), cloth);
  add("Anisotropy", make_base(1, 0.5f), brushed);
  add("Iridescence", make_base(0.3f, 0.5f), film);
  add("DiffuseTransmission", make_base(0, 0.6f), paper);
  add("ThinTransmission", make_rough_glass(0.5f, true));
  add("RoughGlassWithVolume", make_rough_glass(0.6f, false));
  add("HalfGlassWithVolume", make_rough_glass(0.6f, false),
      [](Material& m) { m.transmission->factor = 0.5f; });
  add("Dispersion", make_rough_glass(0.6f, false), [](Material& m) { m.dispersion = 1; });
  add("Conductor", make_base(0, 0.5f), [](Material& m) {
    m.conductor = ConductorModel{{.143f, .422f, .965f}, {3.983f, 2.347f, 6.40f}};
  });
  add("Phong", make_base(0, 1), [](Material& m) {
    m.phong = PhongModel{{0.3f, 0.2f, 0.1f}, {0.2f, 0.4f, 0.6f}, 20};
  });
  add("Everything", make_rough_glass(0.5f, true), [&](Material& m) {
    m.transmission->factor = 0.4f;
    m.metallic = 0.3f;
    coat(m);
    cloth(m);
    brushed(m);
    film(m);
    paper(m);
  });
  return all;
}

/// A ball of the material on a floor, under a lamp and a dim sky.
Scene ball(const Material& material) {
  Scene scene;
  add_mesh(scene, make_uv_sphere({0, 1, 0}, 1, 24), add_material(scene, material));
  add_mesh(scene, make_quad({0, 0, 0}, {4, 0, 0}, {0, 0, -4}), add_material(scene, make_lambert(Rgb(0.5f))));
  add_light(scene, make_area_light(LightKind::rectangle, 4, 2, 2),
            look_along({1.5f, 3.5f, 1.5f}, normalize(Vec3f(-0.4f, -0.8f, -0.4f))));
  scene.environment.radiance = Rgb(0.2f, 0.3f, 0.4f);
  add_eye(scene, {0, 1.6f, 4}, {0, 0.9f, 0}, 0.6f);
  return scene;
}

/// `tolerance` is what the means of whole pictures tell apart (4.5 standard errors), relative.
void expect_strategies_agree(const Material& material, std::uint32_t spp, double tolerance) {
  const Scene scene = ball(material);
  std::array<Picture, 3> pictures;
  for (const Strategy s : {Strategy::mis, Strategy::light, Strategy::bsdf})
    pictures[std::size_t(s)] = render(scene, independent_settings(32, 32, spp, 11 + unsigned(s)), with(s, 5));
  for (const auto& [a, b] : {std::pair{0, 1}, {0, 2}, {1, 2}}) {
    EXPECT_TRUE(blocks_agree(pictures[std::size_t(a)], pictures[std::size_t(b)]))
        << "strategies " << a << " and " << b;
    for (int k = 0; k < 3; ++k)
      EXPECT_TRUE(
          means_agree(mean_of(pictures[std::size_t(a)], k), mean_of(pictures[std::size_t(b)], k), tolerance))
          << "strategies " << a << " and " << b << ", channel " << k;
  }
}

class MaterialPictures : public testing::TestWithParam<int> {
 protected:
  static Material material() { return materials()[std::size_t(GetParam())].material; }
};
INSTANTIATE_TEST_SUITE_P(Extensions, MaterialPictures, testing::Range(0, int(materials().size())),
                         [](const auto& i) { return std::string(materials()[std::size_t(i.param)].name); });

// Catches a density that is not the sampler's, a lobe that only one of eval() and sample() has, a weight that
// does not sum to 1 over the strategies.
TEST_P(MaterialPictures, StrategiesAgree) { expect_strategies_agree(material(), 96, 0.12); }
TEST_P(MaterialPictures, NightlyStrategiesAgree) { expect_strategies_agree(material(), 4096, 0.02); }

/// Mean over a ball of the material that fills the picture, in a furnace of radiance 1.
Mean in_furnace(const Material& material, std::uint32_t spp) {
  Scene scene;
  add_shape(scene, make_sphere(1), add_material(scene, material));
  scene.environment.radiance = Rgb(1, 1, 1);
  add_probe(scene, {0, 0, 0}, normalize(Vec3f(1, 0.4f, 2)), 5, 0.7f);
  return mean_of(render(scene, independent_settings(32, 32, spp), with(Strategy::mis, 1000)), 1);
}

// What reflects gives back what it gets within .002, what light crosses several times within .015: the tables
// of compensation are that exact. Without it a metal of roughness 1 gives back half.
void expect_invisible(const std::vector<float>& roughnesses, std::uint32_t spp, double largest_error) {
  const auto expect = [&](const char* name, const Material& material, double tolerance) {
    const Mean mean = in_furnace(material, spp);
    EXPECT_NEAR(mean.value, 1, tolerance + 4.5 * mean.error) << name << ", roughness " << material.roughness;
    EXPECT_LT(mean.error, largest_error) << name << ", roughness " << material.roughness;
  };
  for (const float roughness : roughnesses) {
    Material m = make_base(1, roughness);
    m.base_color = Rgb(1, 1, 1);
    expect("metal", m, 0.002);
    m.metallic = 0.5f;
    expect("half metal", m, 0.002);
    m.metallic = 0;
    expect("coated base", m, 0.002);
    Material conductor = m;
    conductor.conductor = ConductorModel{Rgb(0), Rgb(1)};
    expect("perfect conductor", conductor, 0.002);
    m.transmission.emplace().factor = 1;
    expect("thin glass", m, 0.015);
    m.volume.emplace().thickness = 1;
    expect("glass", m, 0.015);
  }
  Material sheet = make_base(0, 1);
  sheet.base_color = Rgb(1, 1, 1);
  sheet.specular = 0;
  sheet.diffuse_transmission.emplace().factor = 0.4f;
  expect("sheet", sheet, 0.002);
}
TEST(MaterialFurnace, WhatLosesNothingIsInvisible) { expect_invisible({0.4f, 1}, 256, 0.005); }
TEST(NightlyMaterialFurnace, WhatLosesNothingIsInvisible) {
  expect_invisible({0.1f, 0.2f, 0.3f, 0.5f, 0.8f}, 1024, 0.003);
}

// A lamp under a clear coat is darker by what the coat reflects at the angle it is seen at: 1 - F = .93 at 60
// degrees.
TEST(CoatedLamp, GlowsLessAtFlatAngles) {
  Material lamp = make_emitter({2, 3, 4});
  lamp.clearcoat.emplace().factor = 1;
  Scene scene;
  add_mesh(scene, make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), add_material(scene, lamp));
  const float cosine = 0.5f, sine = std::sqrt(0.75f);
  add_probe(scene, {0, 0, 0}, {sine, 0, cosine}, 3, 0.3f);
  const Picture p = render(scene, independent_settings(8, 8, 4));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(mean_of(p, k).value, float(2 + k) * (1 - (0.04 + 0.96 / 32)), 1e-4);
}

// A wall that glows and a ball, beside a floor that they light at flat angles. Where samples of lights
// forget the coat, mis is 5% above bsdf.
TEST(CoatedLamp, StrategiesAgree) {
  Material lamp = make_emitter({2, 3, 4});
  lamp.clearcoat.emplace().factor = 1;
  Scene scene;
  add_material(scene, lamp);
  add_mesh(scene, make_quad({-1, 0.5f, 0}, {0, 0, -1}, {0, 0.5f, 0}), 0);
  Transform up;
  up.translation = {1, 0.3f, 0};
  add_shape(scene, make_sphere(0.3f), 0, up);
  add_mesh(scene, make_quad({0, 0, 0}, {1, 0, 0}, {0, 0, -1}),
           add_material(scene, make_lambert(Rgb(1, 1, 1))));
  add_probe(scene, {0, 0, 0}, {0, 1, 0}, 3, 0.6f);
  std::array<Mean, 3> means;
  for (const Strategy s : {Strategy::mis, Strategy::light, Strategy::bsdf})
    means[std::size_t(s)] =
        mean_of(render(scene, independent_settings(24, 24, 1024, 3 + unsigned(s)), with(s, 1)), 1);
  EXPECT_TRUE(means_agree(means[0], means[1], 0.02));
  EXPECT_TRUE(means_agree(means[0], means[2], 0.02));
}

}  // namespace
}  // namespace parian
