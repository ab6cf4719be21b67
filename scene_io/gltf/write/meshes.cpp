#include "scene_io/gltf/write/meshes.h"

#include <algorithm>
#include <string>
#include <utility>

#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

/// What the primitive was when it was loaded; nullptr where it was made here, or in another mesh.
const Primitive* primitive_before(const Mesh* mesh_before, const Mesh& mesh, const Primitive& now) {
  if (!mesh_before || now.origin.file != mesh.origin.file || now.origin.index < 0) return nullptr;
  const auto index = std::size_t(now.origin.index);
  return index < mesh_before->primitives.size() ? &mesh_before->primitives[index] : nullptr;
}

bool has_same_arrays(const Primitive& a, const Primitive& b) {
  return a.positions == b.positions && a.normals == b.normals && a.tangents == b.tangents && a.uvs == b.uvs &&
         a.colors == b.colors && a.triangles == b.triangles;
}

class PrimitiveWriter {
 public:
  PrimitiveWriter(Draft& draft, MeshForm form, json& target) : draft_(draft), form_(form), target_(target) {}

  /// `before`: what it was when it was loaded.
  void write(const Primitive& now, const Primitive* before) {
    target_["material"] = now.material;
    const bool is_baked = form_ == MeshForm::baked;
    if (!is_baked && before && has_same_arrays(now, *before)) return;
    const bool is_packed = find_extension(target_, "KHR_draco_mesh_compression") != nullptr;
    erase_extension(target_, "KHR_draco_mesh_compression");
    static const Primitive kNothing;
    // Nothing of a compressed primitive can be read alone; and the file's vertices are not yet deformed.
    const Primitive& was = before && !is_packed && !is_baked ? *before : kNothing;
    drop_others(before && !is_packed && now.positions.size() == before->positions.size(),
                now.positions == was.positions);
    if (is_baked)
      for (const char* name : {"NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1", "COLOR_0"})
        target_["attributes"].erase(name);
    set("POSITION", now.positions, was.positions,
        [&](const auto& a) { return add_positions(draft_.root, draft_.data, a); });
    const auto add = [&](const auto& a) { return add_vectors(draft_.root, draft_.data, a); };
    set("NORMAL", now.normals, was.normals, add);
    set("TANGENT", now.tangents, was.tangents, add);
    set("TEXCOORD_0", now.uvs[0], was.uvs[0], add);
    set("TEXCOORD_1", now.uvs[1], was.uvs[1], add);
    set("COLOR_0", now.colors, was.colors, add);
    if (!(now.triangles == was.triangles)) {
      target_.erase("mode");
      target_["indices"] = add_indices(draft_.root, draft_.data, now.triangles, now.positions.size());
    }
    // Without normals the reader had passed over them.
    if (now.tangents.empty()) target_["attributes"].erase("TANGENT");
  }

 private:
  /// What the file has besides for each vertex makes sense as long as the vertices are as many.
  void drop_others(bool keep, bool same_positions) {
    json& attributes = target_["attributes"];
    if (!attributes.is_object()) attributes = json::object();
    target_.erase("targets");
    json kept = json::object();
    for (auto& [name, accessor] : attributes.items()) {
      const bool deforms = name.starts_with("JOINTS_") || name.starts_with("WEIGHTS_");
      if (keep && (!deforms || same_positions)) kept[name] = std::move(accessor);
    }
    attributes = std::move(kept);
  }

  template <class T, class Add>
  void set(const char* name, const SharedArray<T>& now, const SharedArray<T>& before, const Add& add) {
    if (now == before) return;
    json& attributes = target_["attributes"];
    attributes.erase(name);
    if (!now.empty()) attributes[name] = add(now);
  }

  Draft& draft_;
  MeshForm form_;
  json& target_;
};

bool has_targets(const json& mesh) {
  const json primitives = mesh.value("primitives", json::array());
  return std::ranges::any_of(primitives, [](const json& p) { return p.contains("targets"); });
}

}  // namespace

bool is_unchanged(const Draft& draft, const Mesh& mesh) {
  const Mesh* const before = draft.before(&Scene::meshes, mesh.origin);
  return before && std::ranges::all_of(mesh.primitives, [&](const Primitive& now) {
           const Primitive* const was = primitive_before(before, mesh, now);
           return was && has_same_arrays(now, *was);
         });
}

bool is_deformed(const Draft& draft, const Mesh& mesh) {
  const GltfSource* const source = draft.source_of(mesh.origin);
  const auto index = std::size_t(mesh.origin.index);
  return source && mesh.origin.index >= 0 && index < source->deformed.size() && source->deformed[index];
}

void write_mesh(Draft& draft, const Mesh& mesh, MeshForm form, json& target) {
  const Mesh* const before = draft.before(&Scene::meshes, mesh.origin);
  const GltfSource* const source = draft.source_of(mesh.origin);
  set_name(target, mesh.name, before ? before->name : std::string());
  // All primitives of a mesh have the same targets, or none has any.
  const bool keeps_targets = form == MeshForm::source && is_unchanged(draft, mesh);
  const bool drops_targets = !keeps_targets && has_targets(target);
  json sources = target.value("primitives", json::array());
  json written = json::array();
  std::vector<bool> is_left(sources.size(), true);  // of those that Parian does not draw
  if (before)
    for (const int drawn : source->primitives[std::size_t(mesh.origin.index)])
      is_left[std::size_t(drawn)] = false;
  const auto pass_on = [&](std::size_t end) {
    for (std::size_t i = 0; i < end; ++i) {
      if (is_left[i]) written.push_back(sources[i]);
      is_left[i] = false;
    }
  };
  if (!before) is_left.assign(sources.size(), false);
  for (const Primitive& now : mesh.primitives) {
    if (now.triangles.empty() || now.positions.empty()) continue;  // glTF has no empty ones
    const Primitive* const was = primitive_before(before, mesh, now);
    json element = json::object();
    if (was) {
      const int number = source->primitives[std::size_t(mesh.origin.index)][std::size_t(now.origin.index)];
      pass_on(std::size_t(number));
      element = sources[std::size_t(number)];
    }
    PrimitiveWriter(draft, form, element).write(now, was);
    written.push_back(std::move(element));
  }
  pass_on(sources.size());
  if (drops_targets) {
    target.erase("weights");
    for (json& primitive : written) primitive.erase("targets");
  }
  target["primitives"] = std::move(written);
}

}  // namespace parian
