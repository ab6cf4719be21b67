#include "editing/nodes.h"

#include <utility>

#include "editing/arguments.h"
#include "editing/tree.h"

namespace parian::edit {
namespace {

bool is_unit(const Quatf& q) { return std::abs(q.r * q.r + q.v.dot(q.v) - 1) <= 1e-3f; }

void check_change(const TransformChange& change) {
  if (change.translation && !is_finite(*change.translation))
    refuse("translation: expected 3 finite numbers, in metres");
  if (change.rotation && !is_unit(*change.rotation)) refuse("rotation: expected a unit quaternion");
  if (change.scale && !is_finite(*change.scale)) refuse("scale: expected 3 finite factors");
}

}  // namespace

void rename_node(Scene& scene, int node, std::string name) {
  check_node(scene, node);
  scene.nodes[std::size_t(node)].name = std::move(name);
}

void set_transform(Scene& scene, int node, const TransformChange& change) {
  check_node(scene, node);
  check_change(change);
  Transform t = scene.nodes[std::size_t(node)].transform;
  if (t.matrix) {
    Transform parts = to_transform(t.to_matrix());
    const bool sheared = parts.matrix.has_value();
    if (sheared && change.rotation.has_value() != change.scale.has_value())
      refuse("transform: expected rotation and scale together, since the node's matrix shears or flattens");
    if (sheared && change.translation)
      for (int i = 0; i < 3; ++i) (*parts.matrix)[3][i] = (*change.translation)[i];
    if (sheared && change.rotation) {
      const Imath::M44f& m = *parts.matrix;
      parts.translation = {m[3][0], m[3][1], m[3][2]};
      parts.matrix.reset();
    }
    t = parts;
  }
  if (!t.matrix) {
    t.translation = change.translation.value_or(t.translation);
    t.rotation = change.rotation.value_or(t.rotation);
    t.scale = change.scale.value_or(t.scale);
  }
  scene.nodes[std::size_t(node)].transform = t;
}

void set_matrix(Scene& scene, int node, const Mat4d& matrix) {
  check_node(scene, node);
  scene.nodes[std::size_t(node)].transform = to_transform(matrix);
}

void set_visible(Scene& scene, int node, bool visible) {
  check_node(scene, node);
  scene.nodes[std::size_t(node)].visible = visible;
}

}  // namespace parian::edit
