#include "scene_io/gltf/write/references.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

std::optional<std::size_t> to_number(const json& value) {
  if (value.is_number_unsigned()) return value.get<std::size_t>();
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  if (number < 0 || number > 1e15 || number != std::floor(number)) return std::nullopt;
  return std::size_t(number);
}

/// nullptr where there is no such member.
json* member(json* value, const char* key) {
  if (!value || !value->is_object()) return nullptr;
  const auto found = value->find(key);
  return found == value->end() ? nullptr : &*found;
}

json* extension(json& element, const char* name) { return member(member(&element, "extensions"), name); }

class Walk {
 public:
  Walk(json& root, const Visit& visit) : root_(root), visit_(visit) {}

  void run() {
    one(&root_, "scene", array::kScenes);
    each(array::kScenes, [&](json& scene) {
      list(&scene, "nodes", array::kNodes);
      extended(scene, "EXT_lights_environment", "environment", array::kEnvironments);
    });
    each(array::kNodes, [&](json& node) { visit_node(node); });
    each(array::kMeshes, [&](json& mesh) {
      each_of(member(&mesh, "primitives"), [&](json& primitive) { visit_primitive(primitive); });
    });
    each(array::kMaterials, [&](json& material) {
      texture_uses(material);
      list(extension(material, "MSFT_lod"), "ids", array::kMaterials);
    });
    each(array::kTextures, [&](json& texture) { visit_texture(texture); });
    each(array::kImages, [&](json& image) { one(&image, "bufferView", array::kBufferViews); });
    each(array::kAccessors, [&](json& accessor) { visit_accessor(accessor); });
    each(array::kBufferViews, [&](json& view) {
      one(&view, "buffer", array::kBuffers);
      for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
        one(extension(view, name), "buffer", array::kBuffers);
    });
    each(array::kSkins, [&](json& skin) { visit_skin(skin); });
    if (json* animations = find_array(root_, array::kAnimations)) visit_animations(*animations);
    each(array::kEnvironments, [&](json& environment) { one(&environment, "source", array::kImages); });
    each("/extensions/EXT_lights_image_based/lights", [&](json& light) {
      each_of(member(&light, "specularImages"), [&](json& images) { items(images, array::kImages); });
    });
  }

 private:
  template <class Body>
  void each_of(json* items, const Body& body) {
    if (items && items->is_array())
      for (json& item : *items) body(item);
  }

  template <class Body>
  void each(const std::string& pointer, const Body& body) {
    each_of(find_array(root_, pointer), body);
  }

  /// False: what it refers to is gone.
  bool keep(json& value, const std::string& array) {
    const auto number = to_number(value);
    if (!number) return true;
    std::size_t changed = *number;
    if (!visit_(array, changed)) return false;
    if (changed != *number || !value.is_number_unsigned()) value = changed;
    return true;
  }

  bool one(json* object, const char* key, const std::string& array) {
    json* const value = member(object, key);
    if (!value || keep(*value, array)) return true;
    object->erase(key);
    return false;
  }

  void items(json& values, const std::string& array) {
    if (!values.is_array()) return;
    json kept = json::array();
    for (json& value : values)
      if (keep(value, array)) kept.push_back(std::move(value));
    values = std::move(kept);
  }

  void list(json* object, const char* key, const std::string& array) {
    if (json* const values = member(object, key)) items(*values, array);
  }

  void map(json* object, const char* key, const std::string& array) {
    if (json* const values = member(object, key); values && values->is_object())
      for (json& value : *values) keep(value, array);
  }

  /// An extension that makes no sense without its reference.
  void extended(json& element, const char* name, const char* key, const std::string& array) {
    if (json* const found = extension(element, name); found && !one(found, key, array))
      erase_extension(element, name);
  }

  void visit_node(json& node) {
    list(&node, "children", array::kNodes);
    one(&node, "mesh", array::kMeshes);
    one(&node, "camera", array::kCameras);
    one(&node, "skin", array::kSkins);
    extended(node, "KHR_lights_punctual", "light", array::kLights);
    extended(node, "EXT_lights_area", "light", array::kAreaLights);
    extended(node, "PARIAN_shape", "shape", array::kShapes);
    if (json* const shape = extension(node, "PARIAN_shape")) one(shape, "material", array::kMaterials);
    map(extension(node, "EXT_mesh_gpu_instancing"), "attributes", array::kAccessors);
    list(extension(node, "MSFT_lod"), "ids", array::kNodes);
  }

  void visit_primitive(json& primitive) {
    map(&primitive, "attributes", array::kAccessors);
    one(&primitive, "indices", array::kAccessors);
    one(&primitive, "material", array::kMaterials);
    each_of(member(&primitive, "targets"), [&](json& target) {
      for (json& value : target) keep(value, array::kAccessors);
    });
    one(extension(primitive, "KHR_draco_mesh_compression"), "bufferView", array::kBufferViews);
    json* const mappings = member(extension(primitive, "KHR_materials_variants"), "mappings");
    if (!mappings || !mappings->is_array()) return;
    json kept = json::array();
    for (json& mapping : *mappings)
      if (one(&mapping, "material", array::kMaterials)) kept.push_back(std::move(mapping));
    *mappings = std::move(kept);
  }

  /// Members of any extension that are named as textures are, with an index.
  void texture_uses(json& object) {
    if (!object.is_object()) return;
    for (auto item = object.begin(); item != object.end();) {
      const bool is_use = item.key().ends_with("Texture") && item->is_object() && item->contains("index");
      if (is_use && !one(&*item, "index", array::kTextures)) {
        item = object.erase(item);
        continue;
      }
      if (!is_use && item.key() != "extras") texture_uses(*item);
      ++item;
    }
  }

  void visit_texture(json& texture) {
    one(&texture, "sampler", array::kSamplers);
    one(&texture, "source", array::kImages);
    if (json* const extensions = member(&texture, "extensions"); extensions && extensions->is_object())
      for (json& other : *extensions) one(&other, "source", array::kImages);
  }

  void visit_accessor(json& accessor) {
    one(&accessor, "bufferView", array::kBufferViews);
    json* const sparse = member(&accessor, "sparse");
    one(member(sparse, "indices"), "bufferView", array::kBufferViews);
    one(member(sparse, "values"), "bufferView", array::kBufferViews);
  }

  void visit_skin(json& skin) {
    one(&skin, "inverseBindMatrices", array::kAccessors);
    one(&skin, "skeleton", array::kNodes);
    json* const joints = member(&skin, "joints");
    const std::size_t count = joints ? joints->size() : 0;
    if (joints) items(*joints, array::kNodes);
    if (joints && joints->size() != count) skin = nullptr;
  }

  /// KHR_animation_pointer names what it animates by a text like /nodes/3/translation.
  bool keep_pointer(json& pointer) {
    if (!pointer.is_string()) return true;
    const std::string text = pointer;
    for (const std::string& array : array::kAll) {
      if (!text.starts_with(array + "/")) continue;
      const std::size_t begin = array.size() + 1, end = std::min(text.find('/', begin), text.size());
      json number = json::parse(text.substr(begin, end - begin), nullptr, false);
      if (!to_number(number)) continue;
      if (!keep(number, array)) return false;
      pointer = text.substr(0, begin) + number.dump() + text.substr(end);
      return true;
    }
    return true;
  }

  bool keep_channel(json& channel) {
    json* const target = member(&channel, "target");
    if (!one(target, "node", array::kNodes)) return false;
    json* const pointer = target ? member(extension(*target, "KHR_animation_pointer"), "pointer") : nullptr;
    return !pointer || keep_pointer(*pointer);
  }

  /// Channels that are gone take their samplers with them, and the last one its animation.
  void visit_animations(json& animations) {
    json kept_animations = json::array();
    for (json& animation : animations) {
      each_of(member(&animation, "samplers"), [&](json& sampler) {
        one(&sampler, "input", array::kAccessors);
        one(&sampler, "output", array::kAccessors);
      });
      json kept = json::array();
      json& channels = animation["channels"];
      for (json& channel : channels)
        if (keep_channel(channel)) kept.push_back(std::move(channel));
      const bool any_gone = kept.size() != channels.size();
      channels = std::move(kept);
      if (any_gone) drop_samplers(animation);
      if (!any_gone || !channels.empty()) kept_animations.push_back(std::move(animation));
    }
    animations = std::move(kept_animations);
  }

  static void drop_samplers(json& animation) {
    std::map<std::size_t, std::size_t> numbers;
    json kept = json::array();
    for (json& channel : animation["channels"]) {
      const auto old = channel["sampler"].get<std::size_t>();
      const auto [known, is_new] = numbers.try_emplace(old, kept.size());
      if (is_new) kept.push_back(animation["samplers"][old]);
      channel["sampler"] = known->second;
    }
    animation["samplers"] = std::move(kept);
  }

  json& root_;
  const Visit& visit_;
};

}  // namespace

json* find_array(json& root, const std::string& pointer) {
  const json::json_pointer place(pointer);
  if (!root.contains(place)) return nullptr;
  json& found = root[place];
  return found.is_array() ? &found : nullptr;
}

std::size_t array_size(json& root, const std::string& pointer) {
  const json* const found = find_array(root, pointer);
  return found ? found->size() : 0;
}

json& need_array(json& root, const std::string& pointer) {
  json& found = root[json::json_pointer(pointer)];
  if (!found.is_array()) found = json::array();
  return found;
}

void for_each_reference(json& root, const Visit& visit) { Walk(root, visit).run(); }

void renumber(json& root, const Numbers& numbers) {
  for_each_reference(root, [&](const std::string& array, std::size_t& number) {
    const auto found = numbers.find(array);
    if (found == numbers.end() || number >= found->second.size()) return true;
    if (found->second[number] == kNone) return false;
    number = std::size_t(found->second[number]);
    return true;
  });
}

void keep_only(json& root, const std::string& pointer, const std::vector<bool>& keep) {
  json* const items = find_array(root, pointer);
  if (!items) return;
  json kept = json::array();
  std::vector<int> numbers(items->size(), kNone);
  for (std::size_t i = 0; i < items->size(); ++i) {
    if (!keep[i]) continue;
    numbers[i] = int(kept.size());
    kept.push_back(std::move((*items)[i]));
  }
  const bool all = kept.size() == items->size();
  *items = std::move(kept);
  if (!all) renumber(root, {{pointer, numbers}});
}

std::map<std::string, std::vector<bool>> find_referenced(json& root) {
  std::map<std::string, std::vector<bool>> referenced;
  for (const std::string& array : array::kAll) referenced[array].resize(array_size(root, array));
  for_each_reference(root, [&](const std::string& array, std::size_t& number) {
    std::vector<bool>& of_array = referenced[array];
    if (number < of_array.size()) of_array[number] = true;
    return true;
  });
  return referenced;
}

}  // namespace parian
