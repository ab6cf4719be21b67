/// Images of a scene, each there once.
#pragma once

#include "renderer/scene/scene.h"

namespace parian::edit {

/// The index of an equal image of the scene, or of this one, added behind the others.
int find_or_add_image(Scene& scene, const Image& image);

}  // namespace parian::edit
