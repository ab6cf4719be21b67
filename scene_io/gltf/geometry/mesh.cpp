/// read_meshes(): primitives with their attributes.
#include <utility>

#include "scene_io/gltf/read.h"

namespace parian {
namespace {

// What the specification allows, and KHR_mesh_quantization where it adds to that.
constexpr Components kPosition{.normalized_integers = true, .plain_integers = true};
constexpr Components kDirection{.normalized_integers = true};
constexpr Components kColor{.normalized_integers = true};

template <class Vector>
SharedArray<Vector> read_attribute(AccessorReader& accessors, const GltfDocument& document,
                                   const tinygltf::Primitive& source, const char* name, Components components,
                                   std::size_t vertices, const std::string& where) {
  const auto found = source.attributes.find(name);
  if (found == source.attributes.end()) return {};
  const std::string place = fmt::format("{}/attributes/{}", where, name);
  auto values = accessors.vectors<Vector>(found->second, components, place);
  if (vertices != 0 && values.size() != vertices) {
    document.fail(
        place, fmt::format("expected {} elements, as many as POSITION has, not {}", vertices, values.size()));
  }
  return values;
}

Primitive read_primitive(const GltfDocument& document, AccessorReader& accessors,
                         const tinygltf::Primitive& source, const std::string& where) {
  Primitive primitive;
  primitive.material = source.material;
  primitive.positions = read_attribute<Vec3f>(accessors, document, source, "POSITION", kPosition, 0, where);
  const std::size_t vertices = primitive.positions.size();
  primitive.triangles = read_triangles(accessors, document, source.indices, source.mode, vertices, where);
  const auto read = [&]<class Vector>(const char* name, Components components, SharedArray<Vector>& target) {
    target = read_attribute<Vector>(accessors, document, source, name, components, vertices, where);
  };
  read("NORMAL", kDirection, primitive.normals);
  read("TEXCOORD_0", kPosition, primitive.uvs[0]);
  read("TEXCOORD_1", kPosition, primitive.uvs[1]);
  read("COLOR_0", kColor, primitive.colors);
  const auto repair = [&]<class Vector>(SharedArray<Vector>& target, const auto& make_unit) {
    const Vector* const before = target.data();
    target = make_unit(std::move(target), primitive);
    if (target.data() != before) accessors.claim(target.bytes(), where);  // a copy for this primitive alone
  };
  repair(primitive.normals, unit_normals);
  // Without normals the specification has tangents ignored too: they belong to a frame that is not there.
  if (!primitive.normals.empty()) {
    read("TANGENT", kDirection, primitive.tangents);
    repair(primitive.tangents, unit_tangents);
  }
  return primitive;
}

bool has_triangles(const tinygltf::Primitive& source) {
  return source.mode < 0 || source.mode >= TINYGLTF_MODE_TRIANGLES;
}

}  // namespace

bool is_drawn(const tinygltf::Primitive& primitive) {
  return has_triangles(primitive) && primitive.attributes.contains("POSITION");
}

void read_meshes(const GltfDocument& document, AccessorReader& accessors, Scene& scene, Warnings& warnings) {
  for (std::size_t m = 0; m < document.model.meshes.size(); ++m) {
    const tinygltf::Mesh& source = document.model.meshes[m];
    Mesh mesh{.name = source.name, .primitives = {}};
    for (std::size_t p = 0; p < source.primitives.size(); ++p) {
      const std::string where = fmt::format("/meshes/{}/primitives/{}", m, p);
      if (!is_drawn(source.primitives[p])) {
        // glTF leaves primitives without POSITION to extensions; there is nothing to draw.
        warnings.add(has_triangles(source.primitives[p]) ? "primitives without POSITION are not drawn"
                                                         : "points and lines are not drawn");
        continue;
      }
      Primitive primitive = read_primitive(document, accessors, source.primitives[p], where);
      if (primitive.material == kNone) primitive.material = default_material(document, scene);
      mesh.primitives.push_back(std::move(primitive));
    }
    scene.meshes.push_back(std::move(mesh));
  }
}

}  // namespace parian
