/// write_header().
#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "scene_io/gltf/file/schema.h"
#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

/// The names in all objects of extensions, but for what is somebody's own.
void find_extensions(const json& value, std::set<std::string>& names) {
  if (value.is_array())
    for (const json& item : value) find_extensions(item, names);
  if (!value.is_object()) return;
  for (const auto& [key, item] : value.items()) {
    if (key == "extras") continue;
    if (key == "extensions" && item.is_object())
      for (const auto& [name, extension] : item.items()) names.insert(name);
    find_extensions(item, names);
  }
}

/// KHR_mesh_quantization has no object of its own: attributes of types that core glTF has not say that it is
/// used.
bool is_quantized(json& root) {
  const json* const accessors = find_array(root, array::kAccessors);
  const auto is_extra = [&](const std::string& name, const json& attribute) {
    const json& accessor = (*accessors)[attribute.get<std::size_t>()];
    const int type = accessor["componentType"];
    constexpr int kFloat = 5126, kByte = 5120, kShort = 5122;
    if (name == "POSITION" || name == "NORMAL" || name == "TANGENT") return type != kFloat;
    if (!name.starts_with("TEXCOORD_")) return false;
    return type == kByte || type == kShort || (type != kFloat && !accessor.value("normalized", false));
  };
  const auto any = [&](const json& attributes) {
    for (const auto& [name, attribute] : attributes.items())
      if (is_extra(name, attribute)) return true;
    return false;
  };
  const json* const meshes = find_array(root, array::kMeshes);
  if (!accessors || !meshes) return false;
  for (const json& mesh : *meshes)
    for (const json& primitive : mesh["primitives"]) {
      if (any(primitive.value("attributes", json::object()))) return true;
      for (const json& target : primitive.value("targets", json::array()))
        if (any(target)) return true;
    }
  return false;
}

void set_names(json& root, const char* key, const json& names) {
  if (names.empty())
    root.erase(key);
  else
    root[key] = names;
}

}  // namespace

void write_header(Draft& draft) {
  json& root = draft.root;
  json& asset = root["asset"];
  if (!asset.contains("version")) asset["version"] = "2.0";
  asset["generator"] = "Parian " PARIAN_VERSION;

  // Objects of extensions whose last element has gone.
  for (const char* name :
       {"KHR_lights_punctual", "EXT_lights_area", "KHR_implicit_shapes", "EXT_lights_environment"}) {
    json* const extension = find_extension(root, name);
    if (!extension) continue;
    for (const char* key : {"lights", "shapes", "environments"})
      if (extension->contains(key) && (*extension)[key].empty()) extension->erase(key);
    if (extension->empty()) erase_extension(root, name);
  }
  for (const std::string& array : array::kAll) {  // glTF has no empty ones
    const json* const items = find_array(root, array);
    if (items && items->empty() && root.contains(array.substr(1))) root.erase(array.substr(1));
  }
  std::set<std::string> names;
  find_extensions(root, names);
  if (is_quantized(root)) names.insert("KHR_mesh_quantization");
  const json listed = root.value("extensionsUsed", json::array());
  json used = json::array(), required = json::array();
  for (const json& name : listed) {
    const std::string text = name;
    // One that Parian does not read may be used in ways that it does not see.
    if (names.erase(text) > 0 || !reads_extension(text)) used.push_back(name);
  }
  for (const std::string& name : names) used.push_back(name);
  for (const json& name : root.value("extensionsRequired", json::array()))
    if (std::ranges::find(used, name) != used.end()) required.push_back(name);
  set_names(root, "extensionsUsed", used);
  set_names(root, "extensionsRequired", required);
}

}  // namespace parian
