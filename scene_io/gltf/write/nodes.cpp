/// write_meshes_and_nodes().
#include <algorithm>
#include <utility>

#include "scene_io/gltf/write/deformations.h"
#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

/// The element's transform reads as `before`, unless `all` is to be written.
void write_transform(json& target, const Transform& now, const Transform& before, bool all) {
  if (now == before && !all) return;
  if (now.matrix) {
    for (const char* key : {"translation", "rotation", "scale"}) target.erase(key);
    json matrix = json::array();
    for (int i = 0; i < 16; ++i) matrix.push_back(to_json((*now.matrix)[i / 4][i % 4]));
    target["matrix"] = std::move(matrix);
    return;
  }
  // What goes without saying is left unsaid where the file has not said it.
  const auto set = [&](const char* key, const auto& value, const auto& old, const auto& nothing) {
    const bool differs = all || before.matrix || !(value == old);
    if (differs && (!(value == nothing) || target.contains(key))) target[key] = to_json(value);
  };
  target.erase("matrix");
  set("translation", now.translation, before.translation, Vec3f(0));
  set("rotation", now.rotation, before.rotation, Quatf(1, 0, 0, 0));
  set("scale", now.scale, before.scale, Vec3f(1));
}

bool has_weights(const json& mesh) {
  const json weights = mesh.value("weights", json::array());
  return std::ranges::any_of(weights, [](const json& weight) { return weight.get<double>() != 0; });
}

class NodeWriter {
 public:
  explicit NodeWriter(Draft& draft) : draft_(draft), deformations_(find_deformations(draft)) {}

  void run() {
    write_meshes();
    const Node none;
    for (std::size_t i = 0; i < draft_.scene.nodes.size(); ++i) {
      const Node& now = draft_.scene.nodes[i];
      const GltfSource* const source = draft_.source_of(now.origin);
      const bool is_of_file =
          source && now.origin.index >= 0 && std::size_t(now.origin.index) < source->nodes;
      const Node& before = is_of_file ? source->loaded.nodes[std::size_t(now.origin.index)] : none;
      json& target = draft_.root["nodes"][i];
      set_name(target, name_of(i, before), before.name);
      const bool is_posed = is_of_file && source->posed.contains(now.origin.index);
      write_transform(target, now.transform, before.transform, is_posed);
      target.erase("children");
      if (!now.children.empty()) target["children"] = now.children;
      target.erase("camera");
      if (now.camera != kNone) target["camera"] = now.camera;
      write_mesh_use(target, i);
      if (is_posed && deformations_.keeps_weights[i]) {
        const std::vector<float>& weights = source->posed.at(now.origin.index);
        if (!weights.empty()) set_weights(target, weights);
      }
      write_extensions(target, now, before);
    }
    drop_channels();
    leave_out_made();
  }

 private:
  void write_meshes() {
    const Scene& scene = draft_.scene;
    // Before their elements change, the sources of those that are written twice.
    std::vector<json> also;
    for (const int mesh : deformations_.also_baked) also.push_back(draft_.root["meshes"][std::size_t(mesh)]);
    for (std::size_t k = 0; k < scene.meshes.size(); ++k)
      write_mesh(draft_, scene.meshes[k], deformations_.forms[k], draft_.root["meshes"][k]);
    for (std::size_t k = 0; k < also.size(); ++k) {
      write_mesh(draft_, scene.meshes[std::size_t(deformations_.also_baked[k])], MeshForm::baked, also[k]);
      draft_.root["meshes"].push_back(std::move(also[k]));
    }
  }

  /// A node that is made again has the name of the one that keeps the skin.
  const std::string& name_of(std::size_t i, const Node& before) const {
    const Node& now = draft_.scene.nodes[i];
    const int made = deformations_.made[i];
    if (made == kNone || now.name != before.name) return now.name;
    return draft_.scene.nodes[std::size_t(made)].name;
  }

  static void set_weights(json& target, const std::vector<float>& weights) {
    json& list = target["weights"] = json::array();
    for (const float weight : weights) list.push_back(to_json(weight));
  }

  void write_mesh_use(json& target, std::size_t i) {
    const int mesh = deformations_.mesh[i];
    if (!deformations_.keeps_skin[i]) target.erase("skin");
    if (!deformations_.keeps_weights[i]) target.erase("weights");
    target.erase("mesh");
    if (mesh == kNone) return;
    target["mesh"] = mesh;
    // A node that the file knew nothing of does not take the weights of a mesh that the scene has without.
    const json& element = draft_.root["meshes"][std::size_t(mesh)];
    if (!deformations_.keeps_weights[i] && has_weights(element))
      set_weights(target, std::vector<float>(element["weights"].size(), 0));
  }

  void write_extensions(json& target, const Node& now, const Node& before) {
    write_light(target, now);
    if (now.shape == kNone) {
      erase_extension(target, "PARIAN_shape");
    } else {
      json& shape = need_extension(target, "PARIAN_shape");
      shape["shape"] = now.shape;
      shape["material"] = now.shape_material;
    }
    write_instances(target, now, before);
    if (now.visible != before.visible) {
      erase_extension(target, "KHR_node_visibility");
      if (!now.visible) need_extension(target, "KHR_node_visibility")["visible"] = false;
    }
  }

  void write_light(json& target, const Node& now) {
    const bool area = now.light != kNone && is_area(draft_.scene.lights[std::size_t(now.light)]);
    const char *name = area ? "EXT_lights_area" : "KHR_lights_punctual",
               *other = area ? "KHR_lights_punctual" : "EXT_lights_area";
    erase_extension(target, other);
    if (now.light == kNone)
      erase_extension(target, name);
    else
      need_extension(target, name)["light"] = draft_.lights[std::size_t(now.light)];
  }

  static bool is_area(const Light& light) {
    return light.kind == LightKind::rectangle || light.kind == LightKind::disk;
  }

  void write_instances(json& target, const Node& now, const Node& before) {
    const bool shows = now.mesh != kNone || now.shape != kNone || target.contains("mesh");
    const bool showed = before.mesh != kNone || before.shape != kNone || target.contains("skin");
    if (now.instances == before.instances && (!now.instances.empty() || shows == showed)) return;
    if (now.instances.empty()) {
      erase_extension(target, "EXT_mesh_gpu_instancing");
      return;
    }
    json& attributes = need_extension(target, "EXT_mesh_gpu_instancing")["attributes"];
    if (now.instances.size() != before.instances.size()) attributes = json::object();
    attributes.update(add_instances(draft_.root, draft_.data, now.instances));
  }

  /// Channels of animations that can no longer be, of weights for meshes that have no morph targets any more
  /// and of what moves a node that has a matrix now, get a node that leave_out_made() takes away.
  void drop_channels() {
    const auto has_targets = [&](const json& node) {
      if (!node.contains("mesh")) return false;
      const json& primitives = draft_.root["meshes"][node["mesh"].get<std::size_t>()]["primitives"];
      return std::ranges::any_of(primitives, [](const json& p) { return p.contains("targets"); });
    };
    json* const animations = find_array(draft_.root, array::kAnimations);
    for (std::size_t a = 0; animations && a < animations->size(); ++a)
      for (json& channel : (*animations)[a]["channels"]) {
        if (!channel["target"].contains("node")) continue;
        const json& node = draft_.root["nodes"][channel["target"]["node"].get<std::size_t>()];
        const bool fits =
            channel["target"].value("path", "") == "weights" ? has_targets(node) : !node.contains("matrix");
        if (!fits) channel["target"]["node"] = draft_.root["nodes"].size();
      }
  }

  void leave_out_made() {
    std::vector<bool> keep;
    for (const bool made : deformations_.is_made) keep.push_back(!made);
    keep.push_back(false);
    if (json* const nodes = find_array(draft_.root, array::kNodes)) nodes->push_back(json::object());
    keep_only(draft_.root, array::kNodes, keep);
  }

  Draft& draft_;
  Deformations deformations_;
};

}  // namespace

void write_meshes_and_nodes(Draft& draft) { NodeWriter(draft).run(); }

}  // namespace parian
