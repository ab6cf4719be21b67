/// deform_meshes(): which nodes draw a deformed mesh, and where that goes in the scene.
#include "scene_io/gltf/pose/deform.h"

#include <algorithm>
#include <compare>
#include <set>
#include <utility>

#include "scene_io/gltf/read.h"

namespace parian {
namespace {

/// What makes a mesh of the document into what is drawn: nodes that agree in all share one mesh.
struct Deformation {
  int mesh, skin;
  std::vector<float> weights;  // of morph targets; empty: all are zero
  bool operator==(const Deformation&) const = default;
  auto operator<=>(const Deformation&) const = default;
  bool is_none() const { return skin == kNone && weights.empty(); }
};

/// The nodes of the document that the scene's roots reach, and whether each is visible.
std::map<int, bool> drawn_nodes(const Scene& scene, std::size_t document_nodes) {
  std::map<int, bool> drawn;
  std::vector<std::pair<int, bool>> open;
  for (const int root : scene.roots) open.emplace_back(root, true);
  std::vector<bool> reached(scene.nodes.size(), false);
  while (!open.empty()) {
    const auto [index, parent_is_visible] = open.back();
    open.pop_back();
    const Node& node = scene.nodes[std::size_t(index)];
    if (reached[std::size_t(index)]) continue;
    reached[std::size_t(index)] = true;
    const bool visible = parent_is_visible && node.visible;
    if (std::size_t(index) < document_nodes) drawn[index] = visible;
    for (const int child : node.children) open.emplace_back(child, visible);
  }
  return drawn;
}

struct Deformed {
  Primitive vertices;
  bool mirrored = false;
};

class Deformer {
 public:
  Deformer(const GltfDocument& document, AccessorReader& accessors, const Pose& pose, Scene& scene)
      : document_(document),
        accessors_(accessors),
        pose_(pose),
        scene_(scene),
        skins_(document, accessors, scene.nodes) {}

  DeformedMeshes deform() {
    std::map<Deformation, std::vector<int>> users;
    std::map<int, std::size_t> remaining;  // deformations of each mesh
    const std::map<int, bool> drawn = drawn_nodes(scene_, document_.model.nodes.size());
    for (const auto& [node, visible] : drawn) {
      if (scene_.nodes[std::size_t(node)].mesh == kNone) continue;
      const auto [use, is_new] = users.try_emplace(find_deformation(node));
      use->second.push_back(node);
      if (is_new) ++remaining[use->first.mesh];
    }
    std::map<int, std::pair<int, bool>> shown;  // by node: its mesh, and whether that is in the world
    // None comes before all others of a mesh, and the last may have the place of what nothing draws any more.
    for (const auto& [deformation, nodes] : users) {
      const bool is_last = --remaining[deformation.mesh] == 0 && !kept_.contains(deformation.mesh);
      if (deformation.is_none()) {
        kept_.insert(deformation.mesh);
        continue;
      }
      Mesh mesh = make_mesh(deformation);
      int index = deformation.mesh;
      if (is_last) {
        scene_.meshes[std::size_t(index)] = std::move(mesh);
      } else {
        index = int(scene_.meshes.size());
        scene_.meshes.push_back(std::move(mesh));
      }
      result_.source[index] = deformation.mesh;
      for (const int node : nodes) shown[node] = {index, deformation.skin != kNone};
    }
    // In the order of the nodes, whatever their meshes.
    for (const auto& [node, mesh] : shown) show(node, mesh.first, mesh.second, drawn.at(node));
    return std::move(result_);
  }

 private:
  Deformation find_deformation(int node) {
    const auto& source = document_.model.nodes[std::size_t(node)];
    return {source.mesh, source.skin < 0 ? kNone : source.skin, find_weights(node)};
  }

  /// Those of the animation, else of the node, else of the mesh; empty where all are zero.
  std::vector<float> find_weights(int node) {
    const auto& source = document_.model.nodes[std::size_t(node)];
    const std::size_t targets = morph_target_count(document_, source.mesh);
    if (targets == 0) return {};
    const auto& of_mesh = document_.model.meshes[std::size_t(source.mesh)].weights;
    const auto posed = pose_.find(node);
    const bool from_node = !source.weights.empty();
    const std::string where =
        from_node ? fmt::format("/nodes/{}/weights", node) : fmt::format("/meshes/{}/weights", source.mesh);
    accessors_.claim(targets * sizeof(float), where);
    std::vector<float> weights;
    if (posed != pose_.end() && posed->second.weights) {
      weights = *posed->second.weights;
    } else {
      const auto& stored = from_node ? source.weights : of_mesh;
      weights.assign(stored.begin(), stored.end());
      if (!weights.empty() && weights.size() != targets) {
        document_.fail(
            where, fmt::format("expected {} numbers, as many as the mesh has morph targets, not {}", targets,
                               weights.size()));
      }
    }
    if (std::ranges::all_of(weights, [](float weight) { return weight == 0; })) return {};
    return weights;
  }

  Mesh make_mesh(const Deformation& deformation) {
    const auto& sources = document_.model.meshes[std::size_t(deformation.mesh)].primitives;
    Mesh mesh = scene_.meshes[std::size_t(deformation.mesh)];  // shares all arrays
    const std::string place = fmt::format("/meshes/{}", deformation.mesh);
    accessors_.claim(sources.size() * (sizeof(Primitive) + deformation.weights.size() * sizeof(float)),
                     place);
    using Attributes = std::map<std::string, int>;
    std::map<std::pair<Attributes, std::vector<Attributes>>, Deformed> done;
    std::size_t next = 0;
    for (std::size_t p = 0; p < sources.size(); ++p) {
      if (!is_drawn(sources[p])) continue;
      Primitive& primitive = mesh.primitives[next++];
      const std::string where = fmt::format("{}/primitives/{}", place, p);
      // Primitives often share their vertices; they go on doing so.
      const auto [known, is_new] = done.try_emplace({sources[p].attributes, sources[p].targets});
      Deformed& deformed = known->second;
      if (is_new) deformed = deform(sources[p], deformation, where, primitive);
      Primitive vertices = deformed.vertices;
      vertices.triangles = std::move(primitive.triangles);
      vertices.material = primitive.material;
      primitive = std::move(vertices);
      if (deformed.mirrored) turn_triangles(primitive, where);
      // What became zero.
      primitive.normals = unit_normals(primitive.normals, primitive);
      if (!primitive.normals.empty()) primitive.tangents = unit_tangents(primitive.tangents, primitive);
    }
    return mesh;
  }

  Deformed deform(const tinygltf::Primitive& source, const Deformation& deformation, const std::string& where,
                  const Primitive& rest) {
    Deformed deformed{rest, false};
    if (!deformation.weights.empty())
      apply_targets(document_, accessors_, source, deformation.weights, where, deformed.vertices);
    if (deformation.skin != kNone)
      deformed.mirrored = skins_.apply(deformation.skin, source, where, deformed.vertices);
    return deformed;
  }

  void turn_triangles(Primitive& primitive, const std::string& where) {
    accessors_.claim(primitive.triangles.bytes(), where);
    std::vector<Triangle> turned(primitive.triangles.begin(), primitive.triangles.end());
    for (Triangle& t : turned) std::swap(t[1], t[2]);
    primitive.triangles = std::move(turned);
  }

  /// A skinned mesh is in world space, whatever the node's own place: it goes to a new root of the node's
  /// name that moves nothing. Taking it back through the node's transform would round it, and could not be
  /// where that is singular.
  void show(int node, int mesh, bool in_world, bool visible) {
    Node& source = scene_.nodes[std::size_t(node)];
    if (!in_world) {
      source.mesh = mesh;
      return;
    }
    Node shown;
    shown.name = source.name;
    shown.mesh = mesh;
    shown.instances = source.instances;
    shown.visible = visible;
    source.mesh = kNone;
    result_.shown[node] = int(scene_.nodes.size());
    scene_.roots.push_back(int(scene_.nodes.size()));
    scene_.nodes.push_back(std::move(shown));
  }

  const GltfDocument& document_;
  AccessorReader& accessors_;
  const Pose& pose_;
  Scene& scene_;
  Skins skins_;
  std::set<int> kept_;  // meshes that some node draws undeformed
  DeformedMeshes result_;
};

}  // namespace

DeformedMeshes deform_meshes(const GltfDocument& document, AccessorReader& accessors, const Pose& pose,
                             Scene& scene) {
  const bool has_targets = std::ranges::any_of(document.model.meshes, [](const tinygltf::Mesh& mesh) {
    return std::ranges::any_of(mesh.primitives, [](const auto& p) { return !p.targets.empty(); });
  });
  if (!has_targets && document.model.skins.empty()) return {};
  return Deformer(document, accessors, pose, scene).deform();
}

}  // namespace parian
