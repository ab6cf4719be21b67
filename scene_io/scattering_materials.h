/// Scattering materials by name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/math.h"

namespace parian {

/// What light meets in a body, and at its surface. Coefficients per millimetre.
struct ScatteringMaterial {
  Rgb reduced_scattering{0, 0, 0}, absorption{0, 0, 0};
  float eta = 1.3f;  // index of refraction, against vacuum
  bool operator==(const ScatteringMaterial&) const = default;
};

/// The measured values of a material, or nullopt for a name that is not known.
std::optional<ScatteringMaterial> find_scattering_material(std::string_view name);

/// All names that find_scattering_material() knows.
std::vector<std::string> scattering_material_names();

}  // namespace parian
