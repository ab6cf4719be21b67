/// Metals by name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian {

/// The complex index of refraction of a clean, smooth surface of the metal in air, or nullopt for a name that
/// is not known. Red, green and blue are the measured values at 650, 550 and 450 nm.
std::optional<ConductorModel> find_metal(std::string_view name);

/// All names that find_metal() knows.
std::vector<std::string> metal_names();

}  // namespace parian
