#include "scene_io/scattering_materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace parian {
namespace {

/// What a thick body gives back of light that enters it, by the dipole (Jensen, Marschner, Levoy, Hanrahan
/// 2001, section 2.4).
float dipole_reflectance(float reduced_scattering, float absorption, float eta) {
  const float inside = -1.440f / (eta * eta) + 0.710f / eta + 0.668f + 0.0636f * eta;
  const float a = (1 + inside) / (1 - inside);
  const float albedo = reduced_scattering / (reduced_scattering + absorption);
  const float depth = std::sqrt(3 * (1 - albedo));
  return albedo / 2 * (1 + std::exp(-4.0f / 3 * a * depth)) * std::exp(-depth);
}

struct Published {
  const char* name;
  Rgb reflectance;  // table 1 of the same paper, which has it beside the coefficients
};

TEST(ScatteringMaterials, ReflectAsPublished) {
  const Published published[] = {{"apple", {0.85f, 0.84f, 0.53f}},    {"chicken1", {0.31f, 0.15f, 0.10f}},
                                 {"chicken2", {0.32f, 0.16f, 0.10f}}, {"cream", {0.98f, 0.90f, 0.73f}},
                                 {"ketchup", {0.16f, 0.01f, 0.00f}},  {"marble", {0.83f, 0.79f, 0.75f}},
                                 {"potato", {0.77f, 0.62f, 0.21f}},   {"skimmilk", {0.81f, 0.81f, 0.69f}},
                                 {"skin1", {0.44f, 0.22f, 0.13f}},    {"skin2", {0.63f, 0.44f, 0.34f}},
                                 {"spectralon", {1, 1, 1}},           {"wholemilk", {0.91f, 0.88f, 0.76f}}};
  for (const auto& [name, reflectance] : published) {
    const ScatteringMaterial m = find_scattering_material(name).value();
    // The paper's formula and table agree to 0.008 but for the blue of chicken1, which is off by 0.026.
    const float tolerance = std::string(name) == "chicken1" ? 0.03f : 0.008f;
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(dipole_reflectance(m.reduced_scattering[k], m.absorption[k], m.eta), reflectance[k],
                  tolerance)
          << name << k;
  }
}

// The reflectance does not know it.
TEST(ScatteringMaterials, ArePerMillimetre) {
  const auto marble = find_scattering_material("marble");
  EXPECT_EQ(marble, (ScatteringMaterial{{2.19f, 2.62f, 3.00f}, {0.0021f, 0.0041f, 0.0071f}, 1.5f}));
  for (const std::string& name : scattering_material_names()) {
    const ScatteringMaterial m = find_scattering_material(name).value();
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(m.reduced_scattering[k] + m.absorption[k], 0.1f) << name;
      EXPECT_LT(m.reduced_scattering[k] + m.absorption[k], 21) << name;
    }
  }
}

TEST(ScatteringMaterials, AreListedByTheNamesTheyAreFoundBy) {
  const std::vector<std::string> names = scattering_material_names();
  EXPECT_EQ(names.size(), 12u);
  for (const std::string& name : names) EXPECT_TRUE(find_scattering_material(name)) << name;
  EXPECT_FALSE(find_scattering_material("Marble"));
  EXPECT_FALSE(find_scattering_material(""));
}

}  // namespace
}  // namespace parian
