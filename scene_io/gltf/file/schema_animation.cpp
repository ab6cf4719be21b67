/// Skins and animations of the schema, and the rules for them that fields cannot say.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "renderer/base/error.h"
#include "scene_io/gltf/file/schema.h"

namespace parian {
namespace {

constexpr double kMaxInt = 2147483647;  // what tinygltf holds in an int

using nlohmann::json;

/// One animation. A channel without a node is left alone, whatever its path: extensions animate other things.
void check_animation(json& animation, const std::string& where, const std::string& file) {
  constexpr std::array kPaths = {"translation", "rotation", "scale", "weights"};
  const std::size_t samplers = animation["samplers"].size();
  std::set<std::pair<std::size_t, std::string>> targets;
  for (std::size_t c = 0; c < animation["channels"].size(); ++c) {
    json& channel = animation["channels"][c];
    const std::string place = fmt::format("{}/channels/{}", where, c);
    if (channel["sampler"].get<std::size_t>() >= samplers) {
      throw InputError(file, place + "/sampler", fmt::format("expected an index into {}/samplers", where));
    }
    json& target = channel["target"];
    if (!target.contains("node")) {
      // tinygltf would drop the channel, and with it the numbers of those behind it.
      target["node"] = -1;
      continue;
    }
    const auto& path = target["path"].get_ref<const std::string&>();
    if (std::ranges::find(kPaths, path) == kPaths.end()) {
      throw InputError(file, place + "/target/path",
                       "expected one of \"translation\", \"rotation\", \"scale\", \"weights\"");
    }
    if (!targets.emplace(target["node"].get<std::size_t>(), path).second) {
      throw InputError(file, place + "/target",
                       "expected a node and path that no channel before it in the animation has");
    }
  }
}

}  // namespace

Field skin_fields() {
  return list("skins", {text("name"), index("inverseBindMatrices", "/accessors"),
                        indices("joints", "/nodes").required(), index("skeleton", "/nodes")});
}

Field animation_fields() {
  return list(
      "animations",
      {text("name"),
       list("channels", {integer("sampler").between(0, kMaxInt).required(),
                         object("target", {index("node", "/nodes"), text("path").required()}).required()})
           .required(),
       list("samplers", {index("input", "/accessors").required(), index("output", "/accessors").required(),
                         text("interpolation", {"LINEAR", "STEP", "CUBICSPLINE"})})
           .required()});
}

void check_animations(json& document, const std::string& file) {
  if (!document.contains("animations")) return;
  json& animations = document["animations"];
  for (std::size_t a = 0; a < animations.size(); ++a)
    check_animation(animations[a], fmt::format("/animations/{}", a), file);
}

}  // namespace parian
