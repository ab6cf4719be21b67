/// The parts of load_gltf(): each turns one kind of thing in a checked document into scene data, in the
/// file's order, so that the file's indices hold in the scene (but for textures and images: only those that
/// are used). All throw InputError.
#pragma once

#include <map>
#include <vector>

#include "renderer/scene/scene.h"
#include "scene_io/gltf/file/document.h"
#include "scene_io/gltf/geometry/accessor.h"
#include "scene_io/gltf/gltf.h"
#include "scene_io/gltf/pose/animation.h"

namespace parian {

/// The numbers in the document of what is in the scene, of the kinds that have others there.
struct UsedTextures {
  std::vector<int> textures, images;
};

/// Materials with the textures and images that they and the environment use. Images are decoded in parallel.
UsedTextures read_materials(const GltfDocument& document, const LoadSettings& settings, Scene& scene,
                            Warnings& warnings);

/// The material of what has none: one for the whole file, after those of the file, appended at its first use.
int default_material(const GltfDocument& document, Scene& scene);

/// Decodes the images that `used` names (indices into the document's images), in that order, into memory or
/// beyond it as the settings say. `environment` is the number of the environment map among them, or kNone: it
/// stays in memory.
std::vector<Image> read_images(const GltfDocument& document, const std::vector<int>& used, int environment,
                               const LoadSettings& settings);

/// Triangle meshes. Primitives without material get the default one.
void read_meshes(const GltfDocument& document, AccessorReader& accessors, Scene& scene, Warnings& warnings);

/// Whether read_meshes() keeps the primitive; those of a mesh keep their order.
bool is_drawn(const tinygltf::Primitive& primitive);

/// How many morph targets a mesh of the document has, the same for all its primitives; of kNone none.
std::size_t morph_target_count(const GltfDocument& document, int mesh);

/// Triangles of glTF mode 4 (list), 5 (strip) or 6 (fan), of `indices` or of all vertices where that is
/// kNone; `where` is the primitive's JSON path.
SharedArray<Triangle> read_triangles(AccessorReader& accessors, const GltfDocument& document, int indices,
                                     int mode, std::size_t vertices, const std::string& where);

/// Normals as unit vectors; one of length zero becomes that of a triangle at its vertex.
SharedArray<Vec3f> unit_normals(SharedArray<Vec3f> normals, const Primitive& primitive);

/// Tangents with unit xyz and w of 1 or -1; one of length zero becomes any direction across the normal.
SharedArray<Vec4f> unit_tangents(SharedArray<Vec4f> tangents, const Primitive& primitive);

void read_cameras(const GltfDocument& document, Scene& scene, Warnings& warnings);

/// Punctual lights, then area lights.
void read_lights(const GltfDocument& document, Scene& scene);

/// Shapes. One that Parian cannot draw is refused where a node draws it; else it may be there for another
/// extension's use, and a default shape takes its place.
void read_shapes(const GltfDocument& document, Scene& scene);

/// Nodes in the pose, and as roots those of the default scene. Shapes without material get the default one.
void read_nodes(const GltfDocument& document, AccessorReader& accessors, const Pose& pose, Scene& scene);

/// What deform_meshes() has made.
struct DeformedMeshes {
  std::map<int, int> source;  // by mesh of the scene: that of the document that it was made of
  std::map<int, int> shown;   // by node of the document that has a skin: the node that shows its mesh
};

/// Gives the nodes that are drawn the meshes that morph targets and skins make of theirs, once all else is
/// there. Meshes that nothing deforms stay as they are, and shared.
DeformedMeshes deform_meshes(const GltfDocument& document, AccessorReader& accessors, const Pose& pose,
                             Scene& scene);

/// How many lights of KHR_lights_punctual there are: those of the scene before its area lights.
int punctual_count(const GltfDocument& document);

/// The index of the scene to draw, or kNone where the document has none.
int default_scene(const GltfDocument& document);

}  // namespace parian
