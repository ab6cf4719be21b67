/// Commands on materials as wholes, and on which surface has which. What is refused is a UsageError, and then
/// the scene is as it was. Numbers of a material are properties (properties.h).
#pragma once

#include <string>

#include "renderer/scene/scene.h"

namespace parian::edit {

/// A surface that has a material: a primitive of the mesh that a node shows, or the node's shape.
struct MaterialSlot {
  int node = kNone;
  int primitive = kNone;  // kNone: the shape
};

/// The index of the slot's material.
int material_of(const Scene& scene, const MaterialSlot& slot);

/// Of a mesh, all nodes that show it see the new material.
void assign_material(Scene& scene, const MaterialSlot& slot, int material);

/// Gives the slot a copy of its material, and a copy of its mesh where other nodes show that (vertices
/// are shared): what is done to the material then is seen there alone. Returns the material's index, which is
/// the old one where nothing else had it.
int make_single_user(Scene& scene, const MaterialSlot& slot);

/// A new material behind the others; returns its index. Its textures have to be the scene's.
int add_material(Scene& scene, const Material& material);

/// A copy behind the others; returns its index.
int duplicate_material(Scene& scene, int material);

/// Removes a material; what had it gets `replacement`, another one (its index before the removal).
void remove_material(Scene& scene, int material, int replacement);

void rename_material(Scene& scene, int material, std::string name);

}  // namespace parian::edit
