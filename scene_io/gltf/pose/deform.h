/// What morph targets and skins do to a primitive.
#pragma once

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "scene_io/gltf/pose/animation.h"

namespace parian {

/// v at unit length; zero stays zero.
inline Vec3f unit_or_zero(const Vec3d& v) {
  const double length = std::sqrt(v.dot(v));
  return length > 0 ? Vec3f(v / length) : Vec3f(0);
}

/// Adds `weights` times the primitive's morph targets to its attributes. `source` is the primitive in the
/// document and `where` its JSON path; some weight is not zero. Normals and tangents become unit vectors or
/// zero. Throws InputError.
void apply_targets(const GltfDocument& document, AccessorReader& accessors, const tinygltf::Primitive& source,
                   const std::vector<float>& weights, const std::string& where, Primitive& primitive);

/// The skins of a document in the pose that the scene's nodes have.
class Skins {
 public:
  /// `nodes`: those of the document, in its order, and whatever was appended to them.
  Skins(const GltfDocument& document, AccessorReader& accessors, const std::vector<Node>& nodes);

  /// Takes the primitive's vertices to where the joints of the skin take them, in world space. Normals and
  /// tangents become unit vectors or zero. True if most vertices are mirrored: then the triangles have to be
  /// turned for the outside to stay outside. `source` and `where` as above. Throws InputError.
  bool apply(int skin, const tinygltf::Primitive& source, const std::string& where, Primitive& primitive);

 private:
  const std::vector<Affined>& joints(int skin);

  const GltfDocument& document_;
  AccessorReader& accessors_;
  std::vector<Mat4d> to_world_;                 // of the document's nodes
  std::map<int, std::vector<Affined>> joints_;  // from the mesh to the world, by skin
};

}  // namespace parian
