/// Texels that are not in memory.
#pragma once

#include <cstddef>
#include <span>

#include "renderer/base/math.h"

namespace parian {

/// Where the texels of an image lie that is too large for memory. The one class beside Integrator that is
/// abstract: who looks texels up must not know who keeps them.
class TexelSource {
 public:
  virtual ~TexelSource() = default;

  /// Copies the pixels at `places` (each inside the image) to `out`, one after the other, as Image::pixels
  /// would have them. For any thread. A texel that cannot be read is 0 in every byte; whoever made the source
  /// can say so.
  virtual void fetch(std::span<const Vec2i> places, std::byte* out) const = 0;
};

}  // namespace parian
