#include "editing/tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "editing/arguments.h"

namespace parian::edit {
namespace {

/// The quaternion of an orthonormal right-handed basis, whose vectors are the rows of a matrix that is
/// applied from the right (Shepperd 1978): the largest of the four is found first.
Quatf to_quaternion(const Vec3d& x, const Vec3d& y, const Vec3d& z) {
  const double squares[4] = {1 + x.x + y.y + z.z, 1 + x.x - y.y - z.z, 1 - x.x + y.y - z.z,
                             1 - x.x - y.y + z.z};
  const int largest = int(std::max_element(squares, squares + 4) - squares);
  const double s = 2 * std::sqrt(squares[largest]), q = 0.25 * s;
  const double a = (y.z - z.y) / s, b = (z.x - x.z) / s, c = (x.y - y.x) / s;
  const double d = (x.y + y.x) / s, e = (z.x + x.z) / s, f = (y.z + z.y) / s;
  switch (largest) {
    case 0:
      return Quatf(float(q), float(a), float(b), float(c));
    case 1:
      return Quatf(float(a), float(q), float(d), float(e));
    case 2:
      return Quatf(float(b), float(d), float(q), float(f));
    default:
      return Quatf(float(c), float(e), float(f), float(q));
  }
}

/// Each axis to 1e-5 of its own length: a flat one may shear as well.
bool is_near(const Mat4d& a, const Mat4d& b) {
  for (int i = 0; i < 3; ++i) {
    const Vec3d p(a[i][0], a[i][1], a[i][2]), q(b[i][0], b[i][1], b[i][2]);
    if (!((p - q).length() <= 1e-5 * p.length())) return false;
  }
  return true;
}

}  // namespace

std::vector<int> find_parents(const Scene& scene) {
  std::vector<int> parents(scene.nodes.size(), kNone);
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    for (const int child : scene.nodes[i].children) parents[std::size_t(child)] = int(i);
  return parents;
}

std::vector<int> find_subtree(const Scene& scene, int node) {
  std::vector<int> found, open{node};
  while (!open.empty()) {
    found.push_back(open.back());
    open.pop_back();
    const std::vector<int>& children = scene.nodes[std::size_t(found.back())].children;
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  return found;
}

std::vector<int> find_topmost(const Scene& scene, std::span<const int> nodes) {
  const std::vector<int> parents = find_parents(scene);
  std::vector<char> left(scene.nodes.size(), false);
  for (const int node : nodes) left[std::size_t(node)] = true;
  std::vector<int> topmost;
  for (const int node : nodes) {
    int above = parents[std::size_t(node)];
    while (above != kNone && !left[std::size_t(above)]) above = parents[std::size_t(above)];
    if (above == kNone) topmost.push_back(node);
  }
  std::erase_if(topmost, [&](int node) { return !std::exchange(left[std::size_t(node)], false); });
  return topmost;
}

Mat4d find_to_world(const Scene& scene, int node, const std::vector<int>& parents) {
  Mat4d to_world;
  for (; node != kNone; node = parents[std::size_t(node)])
    to_world = to_world * scene.nodes[std::size_t(node)].transform.to_matrix();
  return to_world;
}

std::vector<int>& children_of(Scene& scene, int parent) {
  return parent == kNone ? scene.roots : scene.nodes[std::size_t(parent)].children;
}

const std::vector<int>& children_of(const Scene& scene, int parent) {
  return parent == kNone ? scene.roots : scene.nodes[std::size_t(parent)].children;
}

std::size_t take_out(std::vector<int>& list, int node) {
  const auto found = std::find(list.begin(), list.end(), node);
  const std::size_t place = std::size_t(found - list.begin());
  if (found != list.end()) list.erase(found);
  return place;
}

Transform to_transform(const Mat4d& matrix) {
  Transform exact;
  exact.matrix = Imath::M44f(matrix);
  // What is affine but for rounding is made so.
  for (int i = 0; i < 4; ++i) {
    if (!(std::abs(matrix[i][3] - (i == 3)) <= 1e-6)) refuse("transform: expected an affine matrix");
    (*exact.matrix)[i][3] = i == 3 ? 1.0f : 0.0f;
  }
  check_element(exact);
  const auto row = [&](int i) { return Vec3d(matrix[i][0], matrix[i][1], matrix[i][2]); };
  Vec3d axes[3] = {row(0), row(1), row(2)};
  Vec3d scale(axes[0].length(), axes[1].length(), axes[2].length());
  if (!(scale.x > 0 && scale.y > 0 && scale.z > 0)) return exact;
  if (axes[0].dot(axes[1].cross(axes[2])) < 0) scale.x = -scale.x;
  for (int i = 0; i < 3; ++i) axes[i] /= scale[i];
  Transform t;
  t.translation = Vec3f(row(3));
  t.rotation = to_quaternion(axes[0], axes[1], axes[2]).normalized();
  t.scale = Vec3f(scale);
  return is_near(matrix, t.to_matrix()) ? t : exact;
}

void move_node(Scene& scene, int node, int parent, std::size_t position, bool keep_world) {
  const std::vector<int> parents = find_parents(scene);
  const int old_parent = parents[std::size_t(node)];
  if (keep_world && old_parent != parent) {
    const Mat4d to_parent = find_to_world(scene, parent, parents);
    if (to_affine(to_parent).determinant() == 0)
      refuse("parent: expected a scale other than 0, since the node is to stay where it is");
    const Mat4d to_world = find_to_world(scene, node, parents);
    scene.nodes[std::size_t(node)].transform = to_transform(to_world * to_parent.inverse());
  }
  take_out(children_of(scene, old_parent), node);
  std::vector<int>& siblings = children_of(scene, parent);
  siblings.insert(siblings.begin() + std::ptrdiff_t(std::min(position, siblings.size())), node);
}

}  // namespace parian::edit
