/// conform(): the schema, and the rules that a schema cannot say.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <set>

#include "renderer/base/error.h"
#include "scene_io/gltf/file/field.h"
#include "scene_io/gltf/file/schema.h"

namespace parian {
namespace {

void check_required(const nlohmann::json& names, const std::string& file) {
  for (std::size_t i = 0; names.is_array() && i < names.size(); ++i) {
    if (!names[i].is_string() || reads_extension(names[i])) continue;
    throw InputError(file, fmt::format("/extensionsRequired/{}", i),
                     fmt::format("expected an extension that Parian reads, {} is not one",
                                 names[i].get_ref<const std::string&>()));
  }
}

void check_version(const nlohmann::json& asset, const std::string& file) {
  const auto require = [&](const char* key, const auto& accepts, const char* expected) {
    if (asset.contains(key) && !accepts(asset[key].template get_ref<const std::string&>())) {
      throw InputError(file, fmt::format("/asset/{}", key), expected);
    }
  };
  require(
      "version", [](const std::string& v) { return v.starts_with("2."); }, "expected glTF version 2");
  require(
      "minVersion", [](const std::string& v) { return v == "2.0"; }, "expected at most glTF version 2.0");
}

/// Relations that tinygltf would refuse without saying where.
void check_relations(const nlohmann::json& document, const std::string& file) {
  static const nlohmann::json kNothing = nlohmann::json::array();
  const auto array = [&](const char* key) -> const nlohmann::json& {
    return document.contains(key) ? document[key] : kNothing;
  };
  const auto fail = [&](const std::string& where, const char* expected) {
    throw InputError(file, where, expected);
  };
  const auto need_member = [&](const nlohmann::json& list, const char* where) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      const auto& type = list[i]["type"].get_ref<const std::string&>();
      const bool needed = type == "perspective" || type == "orthographic" || type == "spot";
      if (needed && !list[i].contains(type)) {
        fail(fmt::format("{}/{}/{}", where, i, type), "expected an object, since type says so");
      }
    }
  };
  need_member(array("cameras"), "/cameras");
  const std::string lights = "/extensions/KHR_lights_punctual/lights";
  const nlohmann::json::json_pointer pointer(lights);
  if (document.contains(pointer)) need_member(document[pointer], lights.c_str());

  const auto& views = array("bufferViews");
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].value("byteStride", 4) % 4 != 0) {
      fail(fmt::format("/bufferViews/{}/byteStride", i), "expected a multiple of 4");
    }
  }
  const auto& meshes = array("meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const auto& primitives = meshes[m]["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const bool indexed = primitives[p].contains("indices");
      if (indexed &&
          !document["accessors"][primitives[p]["indices"].get<std::size_t>()].contains("bufferView")) {
        fail(fmt::format("/meshes/{}/primitives/{}/indices", m, p), "expected an accessor with a bufferView");
      }
    }
  }
}

/// What KHR_implicit_shapes asks of a shape of one of its own types.
void check_shape(const nlohmann::json& shape, const std::string& where, const std::string& file) {
  constexpr std::array kTypes = {"sphere", "box", "cylinder", "capsule", "plane"};
  const auto& type = shape["type"].get_ref<const std::string&>();
  if (std::ranges::find(kTypes, type) == kTypes.end()) return;
  for (const char* key : kTypes) {
    const std::string place = fmt::format("{}/{}", where, key);
    if (key == type && !shape.contains(key)) {
      throw InputError(file, place, "expected an object, since type says so");
    }
    if (key != type && shape.contains(key)) {
      throw InputError(file, place, fmt::format("expected no such member, since type is {}", type));
    }
  }
  if (type != "cylinder" && type != "capsule") return;
  const double bottom = shape[type].value("radiusBottom", 0.25), top = shape[type].value("radiusTop", 0.25);
  if (std::max(bottom, top) < std::numeric_limits<float>::min()) {
    throw InputError(file, fmt::format("{}/{}/radiusTop", where, type),
                     "expected a number above 0, since radiusBottom is 0");
  }
}

/// Here and not on tinygltf's model, which lacks the empty objects that stand for shapes of the default size.
void check_shapes(const nlohmann::json& document, const std::string& file) {
  const std::string where = "/extensions/KHR_implicit_shapes/shapes";
  const nlohmann::json::json_pointer pointer(where);
  if (!document.contains(pointer)) return;
  const nlohmann::json& shapes = document[pointer];
  for (std::size_t i = 0; i < shapes.size(); ++i)
    check_shape(shapes[i], fmt::format("{}/{}", where, i), file);
}

}  // namespace

bool reads_extension(const std::string& name) {
  static const std::set<std::string> names = {"EXT_camera_physical",
                                              "EXT_lights_area",
                                              "EXT_lights_environment",
                                              "EXT_mesh_gpu_instancing",
                                              "EXT_meshopt_compression",
                                              "EXT_texture_webp",
                                              "KHR_draco_mesh_compression",
                                              "KHR_implicit_shapes",
                                              "KHR_lights_punctual",
                                              "KHR_materials_anisotropy",
                                              "KHR_materials_clearcoat",
                                              "KHR_materials_diffuse_transmission",
                                              "KHR_materials_dispersion",
                                              "KHR_materials_emissive_strength",
                                              "KHR_materials_ior",
                                              "KHR_materials_iridescence",
                                              "KHR_materials_sheen",
                                              "KHR_materials_specular",
                                              "KHR_materials_transmission",
                                              "KHR_materials_unlit",
                                              "KHR_materials_volume",
                                              "KHR_materials_volume_scatter",
                                              "KHR_mesh_quantization",
                                              "KHR_node_visibility",
                                              "KHR_texture_transform",
                                              "PARIAN_environment",
                                              "PARIAN_materials_conductor",
                                              "PARIAN_materials_phong",
                                              "PARIAN_materials_priority",
                                              "PARIAN_materials_subsurface",
                                              "PARIAN_shape"};
  return names.contains(name);
}

void conform(nlohmann::json& document, const std::string& file) {
  // First, since such an extension may change what the rest of the document means.
  if (document.is_object() && document.contains("extensionsRequired")) {
    check_required(document["extensionsRequired"], file);
  }
  check_fields(document, document_fields(), file);
  check_version(document["asset"], file);
  check_compression(document, file);  // gives indices that are compressed a bufferView
  check_relations(document, file);
  check_shapes(document, file);
  check_materials(document, file);
  check_animations(document, file);
}

}  // namespace parian
