/// The tree of nodes: who is below whom, and where. Depths are not bounded, so nothing here recurses.
#pragma once

#include <span>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian::edit {

/// The parent of each node; kNone for roots and for nodes that no scene shows.
std::vector<int> find_parents(const Scene& scene);

/// The node and all below it, parents first, children in their order.
std::vector<int> find_subtree(const Scene& scene, int node);

/// Those of the nodes, in their order and each once, that are below none of the others.
std::vector<int> find_topmost(const Scene& scene, std::span<const int> nodes);

/// The product of the transforms from the node, itself included, up to its root. kNone: the identity.
Mat4d find_to_world(const Scene& scene, int node, const std::vector<int>& parents);

/// The children of a node, or for kNone the roots.
std::vector<int>& children_of(Scene& scene, int parent);
const std::vector<int>& children_of(const Scene& scene, int parent);

/// Takes the node out of a list; returns where it stood, or the list's length where it did not.
std::size_t take_out(std::vector<int>& list, int node);

/// Translation, rotation and scale of an affine matrix, where they make each axis again to 1e-5 of its
/// length; else, as where it shears or flattens, the matrix. Throws UsageError where it is not affine or
/// rounds to infinity.
Transform to_transform(const Mat4d& matrix);

/// Moves the node below another (kNone: to the top), to `position` among the children there. The arguments
/// are valid. Throws UsageError where `keep_world` and the parent's scale is 0; then nothing has changed.
void move_node(Scene& scene, int node, int parent, std::size_t position, bool keep_world);

}  // namespace parian::edit
