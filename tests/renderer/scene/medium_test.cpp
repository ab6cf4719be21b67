// What a material's numbers make of its inside. Paths through it: tests/integrators.
#include "renderer/scene/medium.h"

#include <gtest/gtest.h>

#include <cmath>

namespace parian {
namespace {

Material make_wax(const Rgb& color, float anisotropy) {
  Material m;
  m.transmission.emplace().factor = 1;
  m.volume = Volume{.thickness = 1, .attenuation_color = {0.25f, 0.5f, 0.75f}, .attenuation_distance = 0.01f};
  m.scatter = VolumeScatter{.multiscatter_color = color, .anisotropy = anisotropy};
  return m;
}

/// The share of scattering in the extinction of one channel.
float albedo(const Material& m, int channel = 0) {
  const Medium medium = make_medium(m);
  return medium.scattering[channel] / medium.extinction[channel];
}

constexpr float kAnisotropies[] = {-0.9f, -0.5f, 0, 0.3f, 0.8f, 0.99f};

TEST(ScatteringMedium, HasTheAlbedoOfItsColor) {
  // Calculated by hand from the formula of the extension.
  EXPECT_NEAR(albedo(make_wax(Rgb(0), 0)), 0, 1e-5);
  EXPECT_NEAR(albedo(make_wax(Rgb(0.5f), 0)), 0.91171, 1e-5);
  EXPECT_NEAR(albedo(make_wax(Rgb(1), 0)), 1, 1e-6);
  const Material blue = make_wax({0, 0.5f, 1}, 0);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(albedo(blue, k), albedo(make_wax(Rgb(0.5f * float(k)), 0), k));
}

// (1 - a) / (1 - g a), on which what a thick body reflects depends, stays that without anisotropy.
TEST(ScatteringMedium, KeepsItsColorWithAnisotropy) {
  for (const float g : kAnisotropies) {
    for (const float color : {0.0f, 0.5f, 1.0f}) {
      const double isotropic = albedo(make_wax(Rgb(color), 0)), a = albedo(make_wax(Rgb(color), g));
      EXPECT_NEAR((1 - a) / (1 - g * a), 1 - isotropic, 1e-4) << color << " " << g;
    }
    EXPECT_EQ(make_medium(make_wax(Rgb(0.5f), g)).anisotropy, g);
  }
}

// Beer-Lambert's of KHR_materials_volume.
TEST(ScatteringMedium, HasTheExtinctionOfItsVolumeWhateverItsColor) {
  for (const float g : kAnisotropies) {
    for (const float color : {0.0f, 0.5f, 1.0f}) {
      const Rgb extinction = make_medium(make_wax(Rgb(color), g)).extinction;
      EXPECT_NEAR(extinction.x, -std::log(0.25) / 0.01, 1e-3);
      EXPECT_NEAR(extinction.y, -std::log(0.5) / 0.01, 1e-3);
      EXPECT_NEAR(extinction.z, -std::log(0.75) / 0.01, 1e-3);
    }
  }
  Material clear = make_wax(Rgb(0.5f), 0);
  clear.scatter.reset();
  EXPECT_FALSE(make_medium(clear).scatters());
}

TEST(ScatteringMedium, IsClearWithoutADistance) {
  Material m = make_wax(Rgb(0.5f), 0.5f);
  m.volume->attenuation_distance = 0;
  EXPECT_FALSE(make_medium(m).scatters());
  EXPECT_EQ(make_medium(m).extinction, Rgb(0));
}

TEST(ScatteringMedium, IsInsideWhateverTheThicknessWhereLightGetsIn) {
  Material m = make_wax(Rgb(0.5f), 0);
  m.volume->thickness = 0;
  EXPECT_TRUE(m.has_interior());
  m.transmission.reset();
  EXPECT_FALSE(m.has_interior());
  m.diffuse_transmission.emplace();
  EXPECT_TRUE(m.has_interior());
  m.scatter.reset();
  EXPECT_FALSE(m.has_interior());
}

TEST(ScatteringMedium, IsDenseWhereTheMaterialSaysSo) {
  Material m = make_wax(Rgb(0.5f), 0);
  EXPECT_FALSE(make_medium(m).dense);
  m.diffuse_transmission.emplace();
  EXPECT_TRUE(make_medium(m).dense);
}

TEST(SubsurfaceMedium, HasTheNumbersOfItsMaterial) {
  Material m;
  m.ior = 1.4f;
  m.dispersion = 2;
  m.priority = 3;
  m.subsurface = SubsurfaceModel{.absorption = {1, 2, 3}, .reduced_scattering = {400, 500, 600}};
  EXPECT_TRUE(m.has_interior());
  const Medium expected{.ior = 1.4f,
                        .dispersion = 2,
                        .absorption = {1, 2, 3},
                        .priority = 3,
                        .scattering = {400, 500, 600},
                        .extinction = {401, 502, 603},
                        .anisotropy = 0,
                        .dense = true,
                        .diffuse_interface = false};
  EXPECT_EQ(make_medium(m), expected);
  m.volume = Volume{.thickness = 0, .attenuation_color = Rgb(0.5f), .attenuation_distance = 1};
  EXPECT_EQ(make_medium(m), expected);
}

}  // namespace
}  // namespace parian
