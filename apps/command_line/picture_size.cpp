#include "apps/command_line/picture_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "renderer/base/error.h"

namespace parian {

Vec2i parse_size(const std::string& text) {
  Vec2i size;
  char rest;
  if (std::sscanf(text.c_str(), "%dx%d%c", &size.x, &size.y, &rest) != 2 || size.x < 1 || size.y < 1 ||
      size.x > 65536 || size.y > 65536)
    throw UsageError(fmt::format("--size {}: expected WIDTHxHEIGHT, each from 1 to 65536", text));
  return size;
}

Vec2i default_size(const Camera& camera) {
  const float aspect = camera.projection == Projection::orthographic ? camera.xmag / camera.ymag
                       : camera.aspect > 0                           ? camera.aspect
                                                                     : 16.0f / 9;
  return {960, std::clamp(int(std::lround(960 / aspect)), 1, 65536)};
}

}  // namespace parian
