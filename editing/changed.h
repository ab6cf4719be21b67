/// What of a session's structures a difference of scenes touches.
#pragma once

#include "editing/scene_delta.h"

namespace parian {

/// Or-ed flags of Changed for `delta`, the difference of `before` and `after` (delta.changed is not read).
/// The same for both directions. Where the tree is as it was, the time goes with what the edited nodes carry;
/// else with all nodes.
unsigned find_changed(const Scene& before, const Scene& after, const SceneDelta& delta);

/// The part of it that is about nodes and the tree of them.
unsigned find_changed_nodes(const Scene& before, const Scene& after, const SceneDelta& delta);

}  // namespace parian
