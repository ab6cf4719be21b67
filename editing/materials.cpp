#include "editing/materials.h"

#include <algorithm>
#include <utility>

#include "editing/arguments.h"

namespace parian::edit {
namespace {

void check_material(const Scene& scene, int material) {
  check_index(material, scene.materials.size(), "material");
}

/// The place of the index in the scene (const or not).
template <class AnyScene>
auto& material_at(AnyScene& scene, const MaterialSlot& slot) {
  check_node(scene, slot.node);
  auto& node = scene.nodes[std::size_t(slot.node)];
  if (slot.primitive == kNone) {
    if (node.shape == kNone) refuse("node: expected one that shows a shape");
    return node.shape_material;
  }
  if (node.mesh == kNone) refuse("node: expected one that shows a mesh");
  auto& primitives = scene.meshes[std::size_t(node.mesh)].primitives;
  check_index(slot.primitive, primitives.size(), "primitive");
  return primitives[std::size_t(slot.primitive)].material;
}

/// Calls visit(index) for every use of a material.
template <class Visit>
void for_each_use(Scene& scene, const Visit& visit) {
  for (Mesh& mesh : scene.meshes)
    for (Primitive& primitive : mesh.primitives) visit(primitive.material);
  for (Node& node : scene.nodes)
    if (node.shape != kNone) visit(node.shape_material);
}

}  // namespace

int material_of(const Scene& scene, const MaterialSlot& slot) { return material_at(scene, slot); }

void assign_material(Scene& scene, const MaterialSlot& slot, int material) {
  check_material(scene, material);
  material_at(scene, slot) = material;
}

int make_single_user(Scene& scene, const MaterialSlot& slot) {
  const int old = material_at(scene, slot);
  if (slot.primitive != kNone) {
    int& mesh = scene.nodes[std::size_t(slot.node)].mesh;
    if (std::ranges::count(scene.nodes, mesh, &Node::mesh) > 1) {
      scene.meshes.push_back(Mesh(scene.meshes[std::size_t(mesh)]));
      mesh = int(scene.meshes.size()) - 1;
    }
  }
  std::size_t uses = 0;
  for_each_use(scene, [&](int used) { uses += used == old; });
  if (uses == 1) return old;
  const int copy = duplicate_material(scene, old);
  material_at(scene, slot) = copy;
  return copy;
}

int add_material(Scene& scene, const Material& material) {
  check_element(material);
  for_each_texture(material, [&](const TextureRef& use) {
    if (use) check_index(use.texture, scene.textures.size(), "texture");
    if (use.uv_set != 0 && use.uv_set != 1) refuse("texture: expected a UV set of 0 or 1");
    for (const float value : use.transform)
      if (!std::isfinite(value)) refuse("texture: expected a transform of finite numbers");
  });
  scene.materials.push_back(Material(material));
  return int(scene.materials.size()) - 1;
}

int duplicate_material(Scene& scene, int material) {
  check_material(scene, material);
  scene.materials.push_back(Material(scene.materials[std::size_t(material)]));
  return int(scene.materials.size()) - 1;
}

void remove_material(Scene& scene, int material, int replacement) {
  check_material(scene, material);
  check_index(replacement, scene.materials.size(), "replacement");
  if (replacement == material) refuse("replacement: expected another material than the one that goes");
  scene.materials.erase(scene.materials.begin() + material);
  for_each_use(scene, [&](int& used) {
    if (used == material) used = replacement;
    if (used > material) --used;
  });
  for (Node& node : scene.nodes)
    if (node.shape == kNone) node.shape_material = kNone;
}

void rename_material(Scene& scene, int material, std::string name) {
  check_material(scene, material);
  scene.materials[std::size_t(material)].name = std::move(name);
}

}  // namespace parian::edit
