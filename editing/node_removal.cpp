/// The commands of nodes.h that remove.
#include <algorithm>
#include <utility>

#include "editing/arguments.h"
#include "editing/nodes.h"
#include "editing/tree.h"

namespace parian::edit {
namespace {

/// Takes out what `used` does not have; returns the new place of each, kNone for what is gone.
template <class T>
std::vector<int> compact(std::vector<T>& array, const std::vector<bool>& used) {
  std::vector<int> places(array.size(), kNone);
  std::size_t count = 0;
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (!used[i]) continue;
    if (count != i) array[count] = std::move(array[i]);
    places[i] = int(count++);
  }
  array.erase(array.begin() + std::ptrdiff_t(count), array.end());
  return places;
}

void renumber(int& index, const std::vector<int>& places) {
  if (index != kNone) index = places[std::size_t(index)];
}

void mark(std::vector<bool>& used, int index) {
  if (index != kNone) used[std::size_t(index)] = true;
}

/// All links to nodes are of nodes that stay.
std::vector<int> remove_nodes(Scene& scene, const std::vector<bool>& stay) {
  const std::vector<int> places = compact(scene.nodes, stay);
  for (Node& node : scene.nodes)
    for (int& child : node.children) renumber(child, places);
  for (int& root : scene.roots) renumber(root, places);
  return places;
}

/// What nodes show. Returns how many elements are gone, as those below do.
std::size_t remove_unshown(Scene& scene) {
  std::vector<bool> meshes(scene.meshes.size()), shapes(scene.shapes.size()), cameras(scene.cameras.size()),
      lights(scene.lights.size());
  for (const Node& node : scene.nodes) {
    mark(meshes, node.mesh);
    mark(shapes, node.shape);
    mark(cameras, node.camera);
    mark(lights, node.light);
  }
  const std::size_t before =
      scene.meshes.size() + scene.shapes.size() + scene.cameras.size() + scene.lights.size();
  const std::vector<int> mesh_places = compact(scene.meshes, meshes),
                         shape_places = compact(scene.shapes, shapes),
                         camera_places = compact(scene.cameras, cameras),
                         light_places = compact(scene.lights, lights);
  for (Node& node : scene.nodes) {
    renumber(node.mesh, mesh_places);
    renumber(node.shape, shape_places);
    renumber(node.camera, camera_places);
    renumber(node.light, light_places);
  }
  return before - scene.meshes.size() - scene.shapes.size() - scene.cameras.size() - scene.lights.size();
}

std::size_t remove_unused_materials(Scene& scene) {
  std::vector<bool> used(scene.materials.size());
  for (const Node& node : scene.nodes)
    if (node.shape != kNone) mark(used, node.shape_material);
  for (const Mesh& mesh : scene.meshes)
    for (const Primitive& primitive : mesh.primitives) mark(used, primitive.material);
  const std::size_t before = scene.materials.size();
  const std::vector<int> places = compact(scene.materials, used);
  for (Node& node : scene.nodes) {
    if (node.shape == kNone) node.shape_material = kNone;
    renumber(node.shape_material, places);
  }
  for (Mesh& mesh : scene.meshes)
    for (Primitive& primitive : mesh.primitives) renumber(primitive.material, places);
  return before - scene.materials.size();
}

std::size_t remove_unused_images(Scene& scene) {
  std::vector<bool> textures(scene.textures.size()), images(scene.images.size());
  for (const Material& material : scene.materials)
    for_each_texture(material, [&](const TextureRef& use) { mark(textures, use.texture); });
  const std::size_t before = scene.textures.size() + scene.images.size();
  const std::vector<int> texture_places = compact(scene.textures, textures);
  for (Material& material : scene.materials)
    for_each_texture(material, [&](TextureRef& use) { renumber(use.texture, texture_places); });
  for (const Texture& texture : scene.textures) mark(images, texture.image);
  mark(images, scene.environment.image);
  const std::vector<int> image_places = compact(scene.images, images);
  for (Texture& texture : scene.textures) renumber(texture.image, image_places);
  renumber(scene.environment.image, image_places);
  return before - scene.textures.size() - scene.images.size();
}

/// Gives the children what the node did for them: its place and whether they are seen.
void release_children(Scene& scene, const Node& node) {
  const Mat4d matrix = node.transform.to_matrix();
  std::vector<Transform> transforms;  // all before any is set: one may be refused
  for (const int child : node.children) {
    const Transform& t = scene.nodes[std::size_t(child)].transform;
    transforms.push_back(matrix == Mat4d() ? t : to_transform(t.to_matrix() * matrix));
  }
  for (std::size_t i = 0; i < node.children.size(); ++i) {
    Node& child = scene.nodes[std::size_t(node.children[i])];
    child.transform = transforms[i];
    child.visible = child.visible && node.visible;
  }
}

}  // namespace

std::vector<int> remove(Scene& scene, std::span<const int> nodes) {
  for (const int node : nodes) check_node(scene, node);
  std::vector<bool> stay(scene.nodes.size(), true);
  for (const int node : find_topmost(scene, nodes))
    for (const int gone : find_subtree(scene, node)) stay[std::size_t(gone)] = false;
  const auto drop = [&](std::vector<int>& list) {
    std::erase_if(list, [&](int node) { return !stay[std::size_t(node)]; });
  };
  drop(scene.roots);
  for (Node& node : scene.nodes) drop(node.children);
  return remove_nodes(scene, stay);
}

std::vector<int> remove(Scene& scene, int node, Removal removal) {
  if (removal == Removal::subtree) return remove(scene, {&node, 1});
  check_node(scene, node);
  std::vector<int>& siblings = children_of(scene, find_parents(scene)[std::size_t(node)]);
  const auto at = std::ranges::find(siblings, node);
  std::vector<bool> stay(scene.nodes.size(), true);
  stay[std::size_t(node)] = false;
  release_children(scene, scene.nodes[std::size_t(node)]);
  const std::vector<int> heirs = std::exchange(scene.nodes[std::size_t(node)].children, {});
  // What no scene shows, it does not show then either.
  if (at != siblings.end()) siblings.insert(siblings.erase(at), heirs.begin(), heirs.end());
  return remove_nodes(scene, stay);
}

std::size_t remove_unused(Scene& scene) {
  const std::size_t unshown = remove_unshown(scene), materials = remove_unused_materials(scene);
  return unshown + materials + remove_unused_images(scene);
}

}  // namespace parian::edit
