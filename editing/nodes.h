/// Commands on nodes. A node is named by its index in Scene::nodes; an index that is none is a UsageError, as
/// is all else that a command refuses, and then the scene is as it was.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace parian::edit {

void rename_node(Scene& scene, int node, std::string name);

/// What of a transform is given: metres; a unit quaternion, to 1e-3 of its squared length; factors.
struct TransformChange {
  std::optional<Vec3f> translation;
  std::optional<Quatf> rotation;
  std::optional<Vec3f> scale;
};

/// Sets what is given, against the parent, and leaves the rest. A matrix becomes translation, rotation and
/// scale where those make it; of one that shears, the translation alone can be set, or rotation and scale
/// together, which end the shear. Refuses what is not finite and other quaternions.
void set_transform(Scene& scene, int node, const TransformChange& change);

/// Sets the transform against the parent by an affine matrix (row vectors); see to_transform().
void set_matrix(Scene& scene, int node, const Mat4d& matrix);

/// Whether the node and all below it are drawn.
void set_visible(Scene& scene, int node, bool visible);

/// Moves the node, with what is below it, below another (kNone: to the top), to `position` among the children
/// there as they are without it; absent: behind them. `keep_world`: it stays where it is seen; else it
/// keeps its transform. Refuses a parent in the node's own subtree, and one whose scale is 0 with keep_world.
void reparent(Scene& scene, int node, int parent, std::optional<int> position = {}, bool keep_world = true);

/// Moves the node to `position` among its siblings, 0 being the first.
void reorder(Scene& scene, int node, int position);

/// Puts the nodes below a new one that moves nothing, in their order, and returns its index: the last. It
/// stands where the first of them stood. All stay where they are seen. Refuses an empty list, a node named
/// twice, and one that is below another of them.
int group(Scene& scene, std::span<const int> nodes, std::string name);

/// Removes a node that carries nothing but children; they take its place, and stay where they are seen.
/// Returns the new index of each node; kNone for the group's.
std::vector<int> ungroup(Scene& scene, int node);

/// Copies the nodes and all below them; one that is below another of them is copied with that alone. The
/// copies share meshes, shapes, materials, cameras and lights. Each new node stands behind the old one;
/// returns their indices.
std::vector<int> duplicate(Scene& scene, std::span<const int> nodes);
inline int duplicate(Scene& scene, int node) { return duplicate(scene, {&node, 1})[0]; }

enum class Removal : std::uint8_t {
  subtree,    // the node and all below it
  node_alone  // its children take its place, and stay where they are seen
};

/// Removes a node; the others keep their order. What it alone used stays (see remove_unused()). Returns the
/// new index of each node; kNone for what is gone.
std::vector<int> remove(Scene& scene, int node, Removal removal = Removal::subtree);
/// The same of several, each with all below it.
std::vector<int> remove(Scene& scene, std::span<const int> nodes);

/// Removes all meshes, shapes, cameras and lights that no node shows, and the materials, textures and images
/// that nothing uses then. Returns how many elements are gone.
std::size_t remove_unused(Scene& scene);

}  // namespace parian::edit
