/// write_scenes(): the roots and the environment of the default scene.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

/// The place of EXT_lights_environment's frontside that the reader makes this rotation of.
std::optional<std::string> to_frontside(const Quatf& rotation) {
  const float half = std::sqrt(0.5f);
  const std::array<std::pair<const char*, Quatf>, 4> sides = {
      {{"+X", {1, 0, 0, 0}}, {"-X", {0, 0, 1, 0}}, {"+Z", {half, 0, -half, 0}}, {"-Z", {half, 0, half, 0}}}};
  for (const auto& [name, of_side] : sides)
    if (rotation == of_side) return name;
  return std::nullopt;
}

class SceneWriter {
 public:
  explicit SceneWriter(Draft& draft) : draft_(draft) {}

  void run() {
    json& scenes = need_array(draft_.root, array::kScenes);
    std::size_t number = draft_.root.value("scene", std::size_t(0));
    if (!draft_.has_default_scene) {
      number = scenes.size();
      scenes.push_back(json::object());
      draft_.root["scene"] = number;
    }
    leave_out_children(scenes);
    json& target = scenes[number];
    target.erase("nodes");
    if (!draft_.scene.roots.empty()) target["nodes"] = draft_.scene.roots;
    write_environment(target);
  }

 private:
  /// Other scenes keep the roots that still are.
  void leave_out_children(json& scenes) {
    std::vector<bool> has_parent(draft_.scene.nodes.size(), false);
    for (const Node& node : draft_.scene.nodes)
      for (const int child : node.children) has_parent[std::size_t(child)] = true;
    for (json& scene : scenes) {
      if (!scene.contains("nodes")) continue;
      json kept = json::array();
      for (const json& node : scene["nodes"])
        if (!has_parent[node.get<std::size_t>()] && std::ranges::find(kept, node) == kept.end())
          kept.push_back(node);
      scene["nodes"] = std::move(kept);
      if (scene["nodes"].empty()) scene.erase("nodes");
    }
  }

  /// The extensions by which the source's default scene says what the environment is.
  json before_extensions(const Environment& now) {
    if (!draft_.source_of(now.origin)) return json::object();
    const int scene = draft_.default_scene[std::size_t(now.origin.file)];
    if (scene == kNone) return json::object();
    return (*find_array(draft_.root, array::kScenes))[std::size_t(scene)].value("extensions", json::object());
  }

  bool is_same_image(const Environment& now, const Environment& before) const {
    if ((now.image == kNone) != (before.image == kNone)) return false;
    if (now.image == kNone) return true;
    const GltfSource& source = *draft_.source_of(now.origin);
    return draft_.images[std::size_t(now.image)] ==
           draft_.merged(now.origin, array::kImages, std::size_t(source.images[std::size_t(before.image)]));
  }

  void write_environment(json& target) {
    const Environment& now = draft_.scene.environment;
    const GltfSource* const source = draft_.source_of(now.origin);
    const json extensions = before_extensions(now);
    for (const char* name : {"EXT_lights_environment", "PARIAN_environment"}) {
      erase_extension(target, name);
      if (extensions.contains(name)) need_extension(target, name) = extensions[name];
    }
    const Environment before = source ? source->loaded.environment : Environment();
    const bool same_image = source ? is_same_image(now, before) : now.image == kNone;
    if (same_image && now.radiance == before.radiance && now.rotation == before.rotation) return;
    set_environment(target, now, same_image);
  }

  void set_environment(json& target, const Environment& now, bool same_image) {
    const bool is_grey = now.radiance.x == now.radiance.y && now.radiance.y == now.radiance.z;
    const auto frontside = to_frontside(now.rotation);
    json entry = json::object();
    if (json* const use = find_extension(target, "EXT_lights_environment")) {
      entry = need_array(draft_.root, array::kEnvironments)[(*use)["environment"].get<std::size_t>()];
    }
    erase_extension(target, "EXT_lights_environment");
    erase_extension(target, "PARIAN_environment");
    if (now.image != kNone) {
      if (!same_image) entry["source"] = draft_.images[std::size_t(now.image)];
      entry["intensity"] = to_json(is_grey ? now.radiance.x : 1.0f);
      if (frontside) entry["frontside"] = *frontside;
      if (entry.value("frontside", "") == "+X") entry.erase("frontside");
      // Of its own: another scene may have the old one.
      json& entries = need_array(draft_.root, array::kEnvironments);
      need_extension(target, "EXT_lights_environment")["environment"] = entries.size();
      entries.push_back(std::move(entry));
    }
    // What that extension has no word for: colours, other rotations, light without an image.
    const bool says_radiance = now.image == kNone ? now.radiance != Rgb(0) : !is_grey;
    if (says_radiance) need_extension(target, "PARIAN_environment")["radiance"] = to_json(now.radiance);
    if (!frontside || (now.image == kNone && *frontside != "+X"))
      need_extension(target, "PARIAN_environment")["rotation"] = to_json(now.rotation);
  }

  Draft& draft_;
};

}  // namespace

void write_scenes(Draft& draft) { SceneWriter(draft).run(); }

}  // namespace parian
