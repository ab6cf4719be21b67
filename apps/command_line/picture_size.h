/// The size of a picture, as given or by the camera.
#pragma once

#include <string>

#include "renderer/base/math.h"
#include "renderer/scene/scene.h"

namespace parian {

/// WIDTHxHEIGHT, each from 1 to 65536. Throws UsageError.
Vec2i parse_size(const std::string& text);

/// 960 pixels wide in the camera's own shape, 16:9 where it has none.
Vec2i default_size(const Camera& camera);

}  // namespace parian
