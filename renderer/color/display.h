/// The display transform of a finished picture, the only code that knows OpenColorIO.
#pragma once

#include <string>
#include <vector>

#include "renderer/base/image.h"

namespace parian {

/// Views of the default display of the active config: $OCIO if that is set, else the one Parian ships. The
/// first is the default. Throws InputError where the config cannot be read.
std::vector<std::string> display_views();

/// Channels R, G, B of `linear` (linear Rec.709) scaled by 2^exposure through `view` ("" for the default) to
/// display-referred [0, 1]. Throws UsageError naming the views there are where `view` is not one of them,
/// InputError where the config cannot be read or has no linear Rec.709 space.
Picture apply_display(const Picture& linear, const std::string& view, float exposure = 0);

}  // namespace parian
