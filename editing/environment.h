/// Commands on the environment. What is refused is a UsageError, or, of a file that cannot be read, an
/// InputError; then the scene is as it was.
#pragma once

#include <string>

#include "renderer/scene/scene.h"

namespace parian::edit {

/// Surrounds the scene with an equirectangular image, as Environment has it; a radiance of 0 becomes 1. Other
/// images stay in the scene (see remove_unused()).
void set_environment_image(Scene& scene, const Image& image);
void set_environment_image(Scene& scene, const std::string& path);

/// Leaves the plain radiance. Refuses where there is no image.
void remove_environment_image(Scene& scene);

}  // namespace parian::edit
