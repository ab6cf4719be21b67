#include "scene_io/gltf/write/format.h"

#include <algorithm>

namespace parian {
namespace {

using nlohmann::json;

bool is_flat(const json& value) {
  return value.empty() || (value.is_array() && std::ranges::none_of(value, [](const json& item) {
                             return item.is_structured();
                           }));
}

void append(const json& value, const std::string& indent, std::string& text) {
  if (!value.is_structured()) {
    text += value.dump();
    return;
  }
  const bool is_array = value.is_array(), flat = is_flat(value);
  const std::string inner = indent + "  ";
  text += is_array ? '[' : '{';
  bool is_first = true;
  for (const auto& [key, item] : value.items()) {
    if (!is_first) text += flat ? ", " : ",";
    is_first = false;
    if (!flat) text += "\n" + inner;
    if (!is_array) text += json(key).dump() + ": ";
    append(item, inner, text);
  }
  if (!flat) text += "\n" + indent;
  text += is_array ? ']' : '}';
}

}  // namespace

std::string format_json(const json& value) {
  std::string text;
  append(value, "", text);
  return text + "\n";
}

}  // namespace parian
