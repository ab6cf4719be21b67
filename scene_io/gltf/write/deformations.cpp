#include "scene_io/gltf/write/deformations.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace parian {
namespace {

using nlohmann::json;

/// Of all nodes, whatever scene they are in.
std::vector<Mat4d> world_matrices(const Scene& scene) {
  std::vector<Mat4d> matrices(scene.nodes.size());
  std::vector<bool> has_parent(scene.nodes.size(), false);
  for (const Node& node : scene.nodes)
    for (const int child : node.children) has_parent[std::size_t(child)] = true;
  std::vector<std::pair<int, Mat4d>> open;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i)
    if (!has_parent[i]) open.emplace_back(int(i), Mat4d());
  while (!open.empty()) {
    const auto [index, parent] = open.back();
    open.pop_back();
    const Node& node = scene.nodes[std::size_t(index)];
    matrices[std::size_t(index)] = node.transform.to_matrix() * parent;
    for (const int child : node.children) open.emplace_back(child, matrices[std::size_t(index)]);
  }
  return matrices;
}

/// Of the nodes that the roots reach, whether each is visible.
std::map<int, bool> find_visible(const Scene& scene) {
  std::map<int, bool> visible;
  std::vector<std::pair<int, bool>> open;
  for (const int root : scene.roots) open.emplace_back(root, true);
  while (!open.empty()) {
    const auto [index, parent] = open.back();
    open.pop_back();
    const Node& node = scene.nodes[std::size_t(index)];
    visible[index] = parent && node.visible;
    for (const int child : node.children) open.emplace_back(child, parent && node.visible);
  }
  return visible;
}

class Finder {
 public:
  explicit Finder(const Draft& draft) : draft_(draft), scene_(draft.scene) {
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      const Origin& origin = scene_.nodes[i].origin;
      if (draft.source_of(origin)) first_.try_emplace({origin.file, origin.index}, int(i));
    }
    result_.mesh.resize(scene_.nodes.size(), kNone);
    result_.made.resize(scene_.nodes.size(), kNone);
    for (auto* flags : {&result_.keeps_skin, &result_.keeps_weights, &result_.is_made})
      flags->resize(scene_.nodes.size(), false);
    result_.forms.resize(scene_.meshes.size(), MeshForm::source);
    for (std::size_t k = 0; k < scene_.meshes.size(); ++k)
      deformed_.push_back(is_deformed(draft, scene_.meshes[k]));
  }

  Deformations find() {
    std::vector<bool> is_deformed_again(scene_.meshes.size(), false), is_used = is_deformed_again;
    for (std::size_t k = 0; k < scene_.meshes.size(); ++k)
      unchanged_.push_back(deformed_[k] && is_unchanged(draft_, scene_.meshes[k]));
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) keep_skin(int(i));
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) keep_mesh(int(i));
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
      if (result_.mesh[i] == kNone || result_.is_made[i]) continue;
      is_used[std::size_t(result_.mesh[i])] = true;
      if (result_.keeps_weights[i]) is_deformed_again[std::size_t(result_.mesh[i])] = true;
    }
    for (std::size_t k = 0; k < scene_.meshes.size(); ++k) {
      const bool stays = is_deformed_again[k] || (!is_used[k] && unchanged_[k]);
      if (deformed_[k] && !stays) result_.forms[k] = MeshForm::baked;
    }
    for (std::size_t i = 0; i < scene_.nodes.size(); ++i) bake_for(int(i));
    return std::move(result_);
  }

 private:
  const Node& node(int i) const { return scene_.nodes[std::size_t(i)]; }
  const json& element(int i) const { return draft_.root.at("nodes")[std::size_t(i)]; }

  /// Whether node i, which has a skin, will show its mesh as the scene has it; the node that does is made
  /// again then.
  void keep_skin(int i) {
    const Origin& origin = node(i).origin;
    const GltfSource* const source = draft_.source_of(origin);
    if (!source || !element(i).contains("skin") || first_.at({origin.file, origin.index}) != i) return;
    const auto shown = source->shown.find(origin.index);
    if (shown == source->shown.end() || node(i).mesh != kNone) return;
    const auto made = first_.find({origin.file, shown->second});
    if (made == first_.end()) return;
    const Node& now = node(made->second);
    Node expected = source->loaded.nodes[std::size_t(shown->second)];
    const int mesh = std::exchange(expected.mesh, now.mesh);
    const auto visible = visible_nodes().find(i);
    if (visible == visible_nodes().end()) return;
    expected.visible = visible->second;
    expected.name = now.name;
    expected.instances = node(i).instances;
    const bool is_root = std::ranges::find(scene_.roots, made->second) != scene_.roots.end();
    if (!is_root || !(now == expected) || !is_mesh(now.mesh, origin.file, mesh)) return;
    if (!joints_stayed(element(i).at("skin").get<std::size_t>())) return;
    result_.is_made[std::size_t(made->second)] = true;
    result_.made[std::size_t(i)] = made->second;
    result_.keeps_skin[std::size_t(i)] = result_.keeps_weights[std::size_t(i)] = true;
    result_.mesh[std::size_t(i)] = now.mesh;
  }

  /// Whether mesh k of the scene is still number `index` of the file.
  bool is_mesh(int k, int file, int index) const {
    if (k == kNone) return false;
    const Origin& origin = scene_.meshes[std::size_t(k)].origin;
    return origin.file == file && origin.index == index &&
           (!deformed_[std::size_t(k)] || unchanged_[std::size_t(k)]);
  }

  bool joints_stayed(std::size_t skin) {
    const json& joints = draft_.root.at("skins")[skin].at("joints");
    if (!now_) now_ = world_matrices(scene_);
    return std::ranges::all_of(joints, [&](const json& joint) {
      const auto number = joint.get<std::size_t>();
      const Origin& origin = scene_.nodes[number].origin;
      auto& loaded = loaded_[origin.file];
      if (loaded.empty()) loaded = world_matrices(draft_.sources[std::size_t(origin.file)].loaded);
      return (*now_)[number] == loaded[std::size_t(origin.index)];
    });
  }

  /// A node that shows what it has always shown is deformed as ever.
  void keep_mesh(int i) {
    const auto n = std::size_t(i);
    if (result_.keeps_skin[n] || node(i).mesh == kNone) return;
    result_.mesh[n] = node(i).mesh;
    const Node* const before = draft_.before(&Scene::nodes, node(i).origin);
    const GltfSource* const source = draft_.source_of(node(i).origin);
    const bool is_of_file = before && std::size_t(node(i).origin.index) < source->nodes;
    if (!is_of_file || !is_mesh(node(i).mesh, node(i).origin.file, before->mesh)) return;
    result_.keeps_weights[n] = true;
    // One that nothing draws still has the mesh that its skin would deform.
    result_.keeps_skin[n] = element(i).contains("skin") && !visible_nodes().contains(i);
  }

  void bake_for(int i) {
    int& mesh = result_.mesh[std::size_t(i)];
    if (mesh == kNone || result_.keeps_weights[std::size_t(i)] || !deformed_[std::size_t(mesh)]) return;
    if (result_.is_made[std::size_t(i)] || result_.forms[std::size_t(mesh)] == MeshForm::baked) return;
    auto& baked = result_.also_baked;
    const auto known = std::ranges::find(baked, mesh);
    const auto number = known - baked.begin();
    if (known == baked.end()) baked.push_back(mesh);
    mesh = int(scene_.meshes.size()) + int(number);
  }

  const std::map<int, bool>& visible_nodes() {
    if (!visible_) visible_ = find_visible(scene_);
    return *visible_;
  }

  const Draft& draft_;
  const Scene& scene_;
  std::map<std::pair<int, int>, int> first_;  // node of the scene by file and number in it
  std::vector<bool> deformed_, unchanged_;    // by mesh
  std::optional<std::vector<Mat4d>> now_;
  std::map<int, std::vector<Mat4d>> loaded_;  // by file
  std::optional<std::map<int, bool>> visible_;
  Deformations result_;
};

}  // namespace

Deformations find_deformations(const Draft& draft) { return Finder(draft).find(); }

}  // namespace parian
