/// merge_sources().
#include <utility>

#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/uri.h"

namespace parian {
namespace {

using nlohmann::json;

/// Whether the scene has anything of each source.
std::vector<bool> find_used(const Scene& scene, std::size_t sources) {
  std::vector<bool> used(sources, false);
  const auto use = [&](const auto& items) {
    for (const auto& item : items)
      if (item.origin.file >= 0 && std::size_t(item.origin.file) < sources)
        used[std::size_t(item.origin.file)] = true;
  };
  use(scene.nodes);
  use(scene.meshes);
  for (const Mesh& mesh : scene.meshes) use(mesh.primitives);
  use(scene.shapes);
  use(scene.materials);
  use(scene.textures);
  use(scene.images);
  use(scene.cameras);
  use(scene.lights);
  use(std::vector<Environment>{scene.environment});
  return used;
}

/// Uris of images, and of buffers that nothing reads and which therefore stay where they are.
void move_uris(json& document, const GltfSource& source, const std::filesystem::path& to) {
  const std::filesystem::path from = std::filesystem::path(source.path).parent_path();
  for (const std::string& array : {array::kImages, array::kBuffers}) {
    json* const items = find_array(document, array);
    for (std::size_t i = 0; items && i < items->size(); ++i) {
      const bool is_read = array == array::kBuffers && !source.buffers[i].empty();
      if (!is_read && (*items)[i].contains("uri"))
        (*items)[i]["uri"] = move_uri((*items)[i]["uri"].get<std::string>(), from, to);
    }
  }
}

/// What the documents have besides arrays of elements: the first that has a member counts.
void add_missing(json& target, json&& source, bool in_extensions = false) {
  for (auto& [key, value] : source.items()) {
    const bool both = target.contains(key) && target[key].is_object() && value.is_object();
    if (!target.contains(key)) target[key] = std::move(value);
    if (both && (in_extensions || key == "extensions")) add_missing(target[key], std::move(value), true);
  }
}

void add_names(json& target, const json& source, const char* key) {
  if (!source.contains(key)) return;
  json& names = target[key];
  for (const json& name : source[key]) {
    bool known = false;
    for (const json& other : names) known = known || other == name;
    if (!known) names.push_back(name);
  }
}

}  // namespace

void merge_sources(Draft& draft) {
  const std::vector<bool> used = find_used(draft.scene, draft.sources.size());
  draft.first.resize(draft.sources.size());
  draft.count.resize(draft.sources.size());
  draft.default_scene.resize(draft.sources.size(), kNone);
  draft.root = json::object();
  bool is_first = true;
  for (std::size_t s = 0; s < draft.sources.size(); ++s) {
    if (!used[s]) continue;
    const GltfSource& source = draft.sources[s];
    json document = json::parse(source.json.begin(), source.json.end());
    if (array_size(document, array::kScenes) > 0)
      draft.default_scene[s] =
          int(document.value("scene", std::size_t(0)) + array_size(draft.root, array::kScenes));
    if (is_first) draft.has_default_scene = draft.default_scene[s] != kNone;
    if (!is_first) document.erase("scene");
    is_first = false;
    move_uris(document, source, draft.folder);
    auto& first = draft.first[s];
    for (const std::string& array : array::kAll) {
      first[array] = array_size(draft.root, array);
      draft.count[s][array] = array_size(document, array);
    }
    for_each_reference(document, [&](const std::string& array, std::size_t& number) {
      number += first.at(array);
      return true;
    });
    for (const std::string& array : array::kAll) {
      json* const added = find_array(document, array);
      if (!added) continue;
      json& items = need_array(draft.root, array);
      for (json& item : *added) items.push_back(std::move(item));
      *added = json::array();
    }
    draft.buffers.insert(draft.buffers.end(), source.buffers.begin(), source.buffers.end());
    add_names(draft.root, document, "extensionsUsed");
    add_names(draft.root, document, "extensionsRequired");
    add_missing(draft.root, std::move(document));
  }
}

}  // namespace parian
