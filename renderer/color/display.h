/// The display transform of a finished picture, the only code that knows OpenColorIO.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/base/image.h"

namespace parian {

/// Views of the default display of the active config: $OCIO if that is set, else the one Parian ships. The
/// first is the default. Throws InputError where the config cannot be read.
std::vector<std::string> display_views();

/// A view that is used again and again: what it needs of the config is found once.
class Display {
 public:
  /// `view` as in apply_display(). `fast`: with the library's approximations, which are within half of an
  /// eighth bit's step and not the same bits on every machine; for what is only looked at.
  explicit Display(const std::string& view, bool fast = false);
  Picture apply(const Picture& linear, float exposure = 0) const;

 private:
  std::shared_ptr<const struct DisplayProcessor> processor_;
};

/// Channels R, G, B of `linear` (linear Rec.709) scaled by 2^exposure through `view` ("" for the default) to
/// display-referred [0, 1]. Throws UsageError naming the views there are where `view` is not one of them,
/// InputError where the config cannot be read or has no linear Rec.709 space.
Picture apply_display(const Picture& linear, const std::string& view, float exposure = 0);

}  // namespace parian
