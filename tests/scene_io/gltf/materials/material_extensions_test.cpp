// Material extensions. How each is refused when broken: gltf_broken_test.cpp.
#include <gtest/gtest.h>

#include "scene_io/metals.h"
#include "scene_io/scattering_materials.h"
#include "scene_io/statistics.h"
#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfMaterialExtensions : public GltfTest {
 protected:
  void SetUp() override {
    GltfTest::SetUp();
    builder_.root["images"] = {{{"bufferView", builder_.add_bytes(png(path("scratch.png")))}}};
    for (int i = 0; i < 3; ++i) builder_.root["textures"].push_back({{"source", 0}});
  }

  Material material(const json& extensions) {
    builder_.root["materials"] = {{{"extensions", extensions}}};
    for (const auto& [name, value] : extensions.items()) builder_.root["extensionsRequired"].push_back(name);
    scene = load(builder_.glb());
    EXPECT_EQ(warnings, std::vector<std::string>());
    return scene.materials.at(0);
  }

  Scene scene;

 private:
  GltfBuilder builder_;
};

// Textures are numbered as they are first asked for. Each `nth` differs from the others, so that none can be
// in another's place.
json nth(int n) {
  return {{"index", n},
          {"texCoord", n % 2},
          {"extensions", {{"KHR_texture_transform", {{"offset", {n + 1, 0}}}}}}};
}

TextureRef nth_ref(int n) {
  return {.texture = n, .uv_set = n % 2, .transform = {1, 0, float(n + 1), 0, 1, 0}};
}

TEST_F(GltfMaterialExtensions, HaveTheDefaultsOfTheirSpecifications) {
  const json empty = json::object();
  Material expected;
  EXPECT_EQ(material(empty), expected);
  expected.transmission = Transmission{.factor = 0, .texture = {}};
  expected.volume = Volume{.thickness = 0, .attenuation_color = {1, 1, 1}, .attenuation_distance = 0};
  expected.scatter = VolumeScatter{.multiscatter_color = {0, 0, 0}, .anisotropy = 0};
  expected.diffuse_transmission =
      DiffuseTransmission{.factor = 0, .color = {1, 1, 1}, .texture = {}, .color_texture = {}};
  expected.clearcoat = Clearcoat{.factor = 0,
                                 .roughness = 0,
                                 .texture = {},
                                 .roughness_texture = {},
                                 .normal_texture = {},
                                 .normal_scale = 1};
  expected.sheen =
      SheenModel{.color = {0, 0, 0}, .roughness = 0, .color_texture = {}, .roughness_texture = {}};
  expected.anisotropy = Anisotropy{.strength = 0, .rotation = 0, .texture = {}};
  expected.iridescence = Iridescence{.factor = 0,
                                     .ior = 1.3f,
                                     .thickness_minimum = 100,
                                     .thickness_maximum = 400,
                                     .texture = {},
                                     .thickness_texture = {}};
  expected.dispersion = 0;
  expected.priority = 0;
  EXPECT_EQ(material({{"KHR_materials_transmission", empty},
                      {"KHR_materials_volume", empty},
                      {"KHR_materials_volume_scatter", empty},
                      {"KHR_materials_diffuse_transmission", empty},
                      {"KHR_materials_clearcoat", empty},
                      {"KHR_materials_sheen", empty},
                      {"KHR_materials_anisotropy", empty},
                      {"KHR_materials_iridescence", empty},
                      {"KHR_materials_dispersion", empty},
                      {"PARIAN_materials_priority", empty}}),
            expected);
}

TEST_F(GltfMaterialExtensions, AreAbsentWhereTheFileHasNone) {
  const Material m = material({{"KHR_materials_sheen", {{"sheenRoughnessFactor", .5}}}});
  Material expected;
  expected.sheen.emplace().roughness = .5f;
  EXPECT_EQ(m, expected);
}

TEST_F(GltfMaterialExtensions, ReadsTransmission) {
  const Material m = material(
      {{"KHR_materials_transmission", {{"transmissionFactor", .75}, {"transmissionTexture", nth(0)}}}});
  EXPECT_EQ(m.transmission, (Transmission{.factor = .75f, .texture = nth_ref(0)}));
}

TEST_F(GltfMaterialExtensions, ReadsVolumeDispersionAndPriority) {
  const Material m = material({{"KHR_materials_volume",
                                {{"thicknessFactor", .25},
                                 {"thicknessTexture", nth(0)},
                                 {"attenuationDistance", 3},
                                 {"attenuationColor", {.1, .2, .3}}}},
                               {"KHR_materials_dispersion", {{"dispersion", .5}}},
                               {"PARIAN_materials_priority", {{"priority", 7}}}});
  EXPECT_EQ(m.volume,
            (Volume{.thickness = .25f, .attenuation_color = {.1f, .2f, .3f}, .attenuation_distance = 3}));
  EXPECT_EQ(m.dispersion, .5f);
  EXPECT_EQ(m.priority, 7);
  EXPECT_TRUE(scene.textures.empty());  // the thickness is that of the mesh
  EXPECT_EQ(material({{"PARIAN_materials_priority", {{"priority", -2.0}}}}).priority, -2);
}

TEST_F(GltfMaterialExtensions, ReadsDiffuseTransmission) {
  const Material m = material({{"KHR_materials_diffuse_transmission",
                                {{"diffuseTransmissionFactor", .5},
                                 {"diffuseTransmissionColorFactor", {.1, .2, .3}},
                                 {"diffuseTransmissionTexture", nth(0)},
                                 {"diffuseTransmissionColorTexture", nth(1)}}}});
  EXPECT_EQ(
      m.diffuse_transmission,
      (DiffuseTransmission{
          .factor = .5f, .color = {.1f, .2f, .3f}, .texture = nth_ref(0), .color_texture = nth_ref(1)}));
}

TEST_F(GltfMaterialExtensions, ReadsClearcoat) {
  json normal = nth(2);
  normal["scale"] = .125;
  const Material m = material({{"KHR_materials_clearcoat",
                                {{"clearcoatFactor", .5},
                                 {"clearcoatRoughnessFactor", .25},
                                 {"clearcoatTexture", nth(0)},
                                 {"clearcoatRoughnessTexture", nth(1)},
                                 {"clearcoatNormalTexture", normal}}}});
  EXPECT_EQ(m.clearcoat, (Clearcoat{.factor = .5f,
                                    .roughness = .25f,
                                    .texture = nth_ref(0),
                                    .roughness_texture = nth_ref(1),
                                    .normal_texture = nth_ref(2),
                                    .normal_scale = .125f}));
  EXPECT_FALSE(m.normal_texture);
}

TEST_F(GltfMaterialExtensions, ReadsSheen) {
  const Material m = material({{"KHR_materials_sheen",
                                {{"sheenColorFactor", {.1, .2, .3}},
                                 {"sheenRoughnessFactor", .4},
                                 {"sheenColorTexture", nth(0)},
                                 {"sheenRoughnessTexture", nth(1)}}}});
  EXPECT_EQ(m.sheen, (SheenModel{.color = {.1f, .2f, .3f},
                                 .roughness = .4f,
                                 .color_texture = nth_ref(0),
                                 .roughness_texture = nth_ref(1)}));
}

TEST_F(GltfMaterialExtensions, ReadsAnisotropy) {
  const Material m =
      material({{"KHR_materials_anisotropy",
                 {{"anisotropyStrength", .5}, {"anisotropyRotation", -7}, {"anisotropyTexture", nth(0)}}}});
  EXPECT_EQ(m.anisotropy, (Anisotropy{.strength = .5f, .rotation = -7, .texture = nth_ref(0)}));
}

TEST_F(GltfMaterialExtensions, ReadsIridescence) {
  const Material m = material({{"KHR_materials_iridescence",
                                {{"iridescenceFactor", .5},
                                 {"iridescenceIor", 1.75},
                                 {"iridescenceThicknessMinimum", 600},  // may be the larger
                                 {"iridescenceThicknessMaximum", 200},
                                 {"iridescenceTexture", nth(0)},
                                 {"iridescenceThicknessTexture", nth(1)}}}});
  EXPECT_EQ(m.iridescence, (Iridescence{.factor = .5f,
                                        .ior = 1.75f,
                                        .thickness_minimum = 600,
                                        .thickness_maximum = 200,
                                        .texture = nth_ref(0),
                                        .thickness_texture = nth_ref(1)}));
}

TEST_F(GltfMaterialExtensions, ReadsPhongAndConductors) {
  const Material phong =
      material({{"PARIAN_materials_phong",
                 {{"diffuse", {.1, .2, .3}}, {"specular", {.4, .5, .6}}, {"exponent", 50}}}});
  EXPECT_EQ(phong.phong,
            (PhongModel{.diffuse = {.1f, .2f, .3f}, .specular = {.4f, .5f, .6f}, .exponent = 50}));
  EXPECT_FALSE(phong.conductor);
  const Material metal =
      material({{"PARIAN_materials_conductor", {{"eta", {.1, .2, .3}}, {"k", {4, 5, 6}}}}});
  EXPECT_EQ(metal.conductor, (ConductorModel{.eta = {.1f, .2f, .3f}, .k = {4, 5, 6}}));
  EXPECT_EQ(material({{"PARIAN_materials_conductor", {{"name", "gold"}}}}).conductor, find_metal("gold"));
}

TEST_F(GltfMaterialExtensions, ReadsVolumeScatter) {
  const Material m = material({{"KHR_materials_volume", json::object()},
                               {"KHR_materials_volume_scatter",
                                {{"multiscatterColor", {.572, .227, .075}}, {"scatterAnisotropy", -.999}}}});
  EXPECT_EQ(m.scatter, (VolumeScatter{.multiscatter_color = {.572f, .227f, .075f}, .anisotropy = -.999f}));
}

void expect_close(const Rgb& color, const Rgb& expected) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(color[k], expected[k], 1e-6 * expected[k]);
}

TEST_F(GltfMaterialExtensions, ReadsSubsurfacePerMetreOfTheScene) {
  const json given = {{"sigmaA", {.1, .2, .3}}, {"sigmaSPrime", {4, 5, 6}}};
  const Material m = material({{"PARIAN_materials_subsurface", given}});
  expect_close(m.subsurface.value().absorption, {100, 200, 300});
  expect_close(m.subsurface->reduced_scattering, {4000, 5000, 6000});
  EXPECT_EQ(m.ior, 1.3f);
  json large = given;
  large.update({{"eta", 1.6}, {"scale", 10}});
  const Material n =
      material({{"PARIAN_materials_subsurface", large}, {"KHR_materials_ior", {{"ior", 1.1}}}});
  expect_close(n.subsurface.value().absorption, {10, 20, 30});
  expect_close(n.subsurface->reduced_scattering, {400, 500, 600});
  EXPECT_EQ(n.ior, 1.6f);
}

TEST_F(GltfMaterialExtensions, ReadsSubsurfaceByName) {
  const ScatteringMaterial marble = find_scattering_material("marble").value();
  const Material m = material({{"PARIAN_materials_subsurface", {{"name", "marble"}, {"scale", .5}}}});
  expect_close(m.subsurface.value().absorption, marble.absorption * 2000);
  expect_close(m.subsurface->reduced_scattering, marble.reduced_scattering * 2000);
  EXPECT_EQ(m.ior, 1.5f);
}

// The coefficients are those with which a thick body gives back the colour.
TEST_F(GltfMaterialExtensions, ReadsSubsurfaceByColour) {
  const json given = {{"color", {0, .291, 1}}, {"meanFreePath", {1, .5, 2}}, {"eta", 1.3}, {"scale", 10}};
  const Material m = material({{"PARIAN_materials_subsurface", given}});
  const Rgb scattering = m.subsurface.value().reduced_scattering, absorption = m.subsurface->absorption;
  expect_close(scattering + absorption, {100, 200, 50});
  EXPECT_EQ(scattering.x, 0);
  EXPECT_NEAR(scattering.y / 200, 0.9, 3e-4);
  EXPECT_EQ(absorption.z, 0);
}

// What the schema lets through is a scene that validate() takes.
TEST_F(GltfMaterialExtensions, ReadsSubsurfaceAtTheEndsOfItsRanges) {
  const json most = {{"sigmaA", {1e9, 1e9, 1e9}}, {"sigmaSPrime", {1e9, 1e9, 1e9}}, {"scale", 1e-9}};
  EXPECT_EQ(material({{"PARIAN_materials_subsurface", most}}).subsurface->absorption, Rgb(1e21f));
  const json least = {{"sigmaA", {0, 0, 0}}, {"sigmaSPrime", {0, 0, 0}}, {"eta", 1}, {"scale", 1e9}};
  EXPECT_EQ(material({{"PARIAN_materials_subsurface", least}}).subsurface, SubsurfaceModel());
}

TEST_F(GltfMaterialExtensions, AreCountedInTheDescription) {
  const json empty = json::object();
  material({{"KHR_materials_transmission", empty}, {"PARIAN_materials_conductor", {{"name", "gold"}}}});
  scene.materials.push_back(scene.materials[0]);
  scene.materials[0].conductor.reset();
  EXPECT_NE(describe(scene, make_world(scene)).find("\nwith         2 transmission, 1 conductor\n"),
            std::string::npos);
  material({{"KHR_materials_volume", empty},
            {"KHR_materials_volume_scatter", empty},
            {"PARIAN_materials_priority", {{"priority", 1}}}});
  EXPECT_NE(
      describe(scene, make_world(scene)).find("\nwith         1 volume, 1 volume scatter, 1 priority\n"),
      std::string::npos);
  material({{"PARIAN_materials_subsurface", {{"name", "skin1"}}}});
  EXPECT_NE(describe(scene, make_world(scene)).find("\nwith         1 subsurface\n"), std::string::npos);
  EXPECT_EQ(describe(Scene(), make_world(Scene())).find("with "), std::string::npos);
}

}  // namespace
}  // namespace parian
