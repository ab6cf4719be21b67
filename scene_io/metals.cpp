#include "scene_io/metals.h"

namespace parian {
namespace {

struct Metal {
  const char* name;
  ConductorModel model;
};

const ConductorModel kAluminium = {{1.558f, 1.015f, 0.633f}, {7.712f, 6.627f, 5.454f}};

// Interpolated linearly in the wavelength, at 650, 550 and 450 nm, from the tables of the
// refractiveindex.info database (M. N. Polyanskiy, CC0), which gives them as published:
//   silver, gold, copper: P. B. Johnson, R. W. Christy, Phys. Rev. B 6, 4370 (1972)
//   aluminium: A. D. Rakic, Appl. Opt. 34, 4755 (1995)
//   iron, chromium, nickel, cobalt, titanium: P. B. Johnson, R. W. Christy, Phys. Rev. B 9, 5056 (1974)
//   platinum, tungsten: A. D. Rakic et al., Appl. Opt. 37, 5271 (1998), the Brendel-Bormann model
//   zinc: W. S. M. Werner et al., J. Phys. Chem. Ref. Data 38, 1013 (2009), from density functional theory:
//     no optical measurement in the database covers the visible but one that is far from every other source
//   brass, 70% copper and 30% zinc: M. R. Querry, report CRDC-CR-85034 (1985)
const Metal kMetals[] = {
    {"silver", {{0.052f, 0.060f, 0.040f}, {4.409f, 3.597f, 2.648f}}},
    {"gold", {{0.156f, 0.424f, 1.383f}, {3.602f, 2.472f, 1.915f}}},
    {"copper", {{0.238f, 1.007f, 1.240f}, {3.626f, 2.582f, 2.393f}}},
    {"aluminium", kAluminium},
    {"aluminum", kAluminium},
    {"iron", {{2.911f, 2.950f, 2.584f}, {3.089f, 2.932f, 2.767f}}},
    {"chromium", {{3.107f, 3.181f, 2.323f}, {3.331f, 3.329f, 3.135f}}},
    {"nickel", {{1.990f, 1.921f, 1.729f}, {4.209f, 3.616f, 2.944f}}},
    {"cobalt", {{2.237f, 2.052f, 1.736f}, {4.236f, 3.824f, 3.274f}}},
    {"titanium", {{2.741f, 2.542f, 2.267f}, {3.814f, 3.435f, 3.038f}}},
    {"platinum", {{2.376f, 2.085f, 1.845f}, {4.265f, 3.715f, 3.136f}}},
    {"tungsten", {{3.652f, 3.506f, 3.313f}, {2.795f, 2.758f, 2.605f}}},
    {"zinc", {{3.416f, 1.929f, 1.042f}, {7.033f, 6.396f, 5.125f}}},
    {"brass", {{0.444f, 0.527f, 1.094f}, {3.695f, 2.765f, 1.829f}}},
};

}  // namespace

std::optional<ConductorModel> find_metal(std::string_view name) {
  for (const Metal& metal : kMetals) {
    if (metal.name == name) return metal.model;
  }
  return std::nullopt;
}

std::vector<std::string> metal_names() {
  std::vector<std::string> names;
  for (const Metal& metal : kMetals) names.emplace_back(metal.name);
  return names;
}

}  // namespace parian
