/// check_compression(): what fields cannot say of EXT_meshopt_compression and KHR_draco_mesh_compression.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "renderer/base/error.h"
#include "scene_io/gltf/file/schema.h"

namespace parian {
namespace {

using nlohmann::json;

struct Rules {
  const std::string& file;
  void require(bool holds, const std::string& where, std::string_view expected) const {
    if (!holds) throw InputError(file, where, expected);
  }
};

const json& array(const json& document, const char* key) {
  static const json kNothing = json::array();
  return document.contains(key) ? document[key] : kNothing;
}

bool is_marked_fallback(const json& document, const json& buffer) {
  const json& extensions = document["buffers"][buffer.get<std::size_t>()].value("extensions", json::object());
  return extensions.contains("EXT_meshopt_compression") &&
         extensions["EXT_meshopt_compression"].value("fallback", false);
}

void check_meshopt(const Rules& rules, const json& view, const json& extension, const std::string& where) {
  const auto stride = extension["byteStride"].get<std::uint64_t>();
  const auto count = extension["count"].get<std::uint64_t>();
  const std::string mode = extension["mode"], filter = extension.value("filter", "NONE");
  const std::string here = where + "/extensions/EXT_meshopt_compression";
  rules.require(view.value("byteStride", stride) == stride, here + "/byteStride",
                "expected the byteStride of the bufferView");
  if (mode == "ATTRIBUTES") {
    rules.require(stride % 4 == 0, here + "/byteStride", "expected a multiple of 4");
    rules.require(filter != "OCTAHEDRAL" || stride == 4 || stride == 8, here + "/byteStride",
                  "expected 4 or 8, for the filter OCTAHEDRAL");
    rules.require(filter != "QUATERNION" || stride == 8, here + "/byteStride",
                  "expected 8, for the filter QUATERNION");
  } else {
    rules.require(stride == 2 || stride == 4, here + "/byteStride", "expected 2 or 4, for the mode " + mode);
    rules.require(filter == "NONE", here + "/filter", "expected \"NONE\", for the mode " + mode);
    rules.require(mode != "TRIANGLES" || count % 3 == 0, here + "/count", "expected a multiple of 3");
  }
  rules.require(
      view["byteLength"].get<std::uint64_t>() == stride * count, where + "/byteLength",
      fmt::format("expected {}, the byteStride times the count of its compression", stride * count));
}

/// Numbers that may not fit into the int that tinygltf would make of them become doubles, which it keeps.
void widen(json& extension) {
  for (const char* key : {"byteOffset", "byteLength"}) {
    if (extension.contains(key)) extension[key] = extension[key].get<double>();
  }
}

void check_views(const Rules& rules, json& document) {
  if (!document.contains("bufferViews")) return;
  json& views = document["bufferViews"];
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::string where = fmt::format("/bufferViews/{}", i);
    const json::json_pointer place("/extensions/EXT_meshopt_compression");
    const bool is_compressed = views[i].contains(place);
    const std::string from = is_compressed ? where + place.to_string() : where;
    const json& source = is_compressed ? views[i][place] : views[i];
    rules.require(!is_marked_fallback(document, source["buffer"]), from + "/buffer",
                  "expected a buffer that is not marked as a fallback");
    if (!is_compressed) continue;
    check_meshopt(rules, views[i], source, where);
    const auto end =
        views[i].value("byteOffset", std::uint64_t(0)) + views[i]["byteLength"].get<std::uint64_t>();
    const auto size =
        document["buffers"][views[i]["buffer"].get<std::size_t>()]["byteLength"].get<std::uint64_t>();
    rules.require(end <= size, where + "/byteLength",
                  fmt::format("expected byteOffset + byteLength of at most {}, the length of buffer {}", size,
                              views[i]["buffer"].get<std::size_t>()));
    widen(views[i][place]);
  }
}

/// An accessor whose elements come from a Draco stream: what else it says of where they lie does not count.
/// Until decode_draco() has them the stream's bufferView stands there, since tinygltf wants one of all
/// indices.
void detach(json& document, std::size_t accessor, const json& stream) {
  json& target = document["accessors"][accessor];
  target.erase("byteOffset");
  target.erase("sparse");
  target["bufferView"] = stream;
}

void check_primitive(const Rules& rules, json& document, const json& primitive, const std::string& where) {
  const json::json_pointer place("/extensions/KHR_draco_mesh_compression");
  if (!primitive.contains(place)) return;
  const json& extension = primitive[place];
  const int mode = primitive.value("mode", 4);
  rules.require(mode == 4 || mode == 5, where + "/mode",
                "expected 4 or 5, triangles or a strip, since KHR_draco_mesh_compression is there");
  for (const auto& [name, id] : extension["attributes"].items()) {
    const json& attributes = primitive["attributes"];
    rules.require(attributes.contains(name), where + place.to_string() + "/attributes/" + name,
                  "expected the name of an attribute of the primitive");
    detach(document, attributes[name].get<std::size_t>(), extension["bufferView"]);
  }
  if (primitive.contains("indices")) {
    detach(document, primitive["indices"].get<std::size_t>(), extension["bufferView"]);
  }
}

}  // namespace

void check_compression(json& document, const std::string& file) {
  const Rules rules{file};
  check_views(rules, document);
  for (std::size_t m = 0; m < array(document, "meshes").size(); ++m) {
    const json& primitives = document["meshes"][m]["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      check_primitive(rules, document, primitives[p], fmt::format("/meshes/{}/primitives/{}", m, p));
    }
  }
}

}  // namespace parian
