/// write_shapes().
#include <string>

#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

const char* to_gltf(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::sphere:
      return "sphere";
    case ShapeKind::cylinder:
      return "cylinder";
    case ShapeKind::box:
      return "box";
    case ShapeKind::plane:
      return "plane";
  }
  return "";
}

void write_values(json& values, const Shape& now, const Shape& before, bool is_other) {
  if (!values.is_object()) values = json::object();
  switch (now.kind) {
    case ShapeKind::sphere:
      set_changed(values, "radius", now.radius, before.radius);
      break;
    case ShapeKind::cylinder:
      set_changed(values, "height", now.height, before.height);
      set_changed(values, "radiusBottom", now.radius_bottom, before.radius_bottom);
      set_changed(values, "radiusTop", now.radius_top, before.radius_top);
      break;
    case ShapeKind::box:
      set_changed(values, "size", now.size, before.size);
      break;
    case ShapeKind::plane:  // which is infinite where it does not say its sides
      if (is_other || now.size.x != before.size.x) values["sizeX"] = to_json(now.size.x);
      if (is_other || now.size.z != before.size.z) values["sizeZ"] = to_json(now.size.z);
      break;
  }
}

}  // namespace

void write_shapes(Draft& draft) {
  for (std::size_t i = 0; i < draft.scene.shapes.size(); ++i) {
    const Shape& now = draft.scene.shapes[i];
    const Shape* const known = draft.before(&Scene::shapes, now.origin);
    json& target = need_array(draft.root, array::kShapes)[i];
    const Shape& named = known ? *known : Shape();
    set_name(target, now.name, named.name);
    if (known && now == *known) continue;
    // The reader has a default shape in place of one that it cannot draw: that becomes another only here.
    const bool is_other = !known || target.value("type", "") != to_gltf(now.kind);
    if (is_other) {
      for (const char* type : {"sphere", "cylinder", "box", "plane", "capsule"}) target.erase(type);
      target["type"] = to_gltf(now.kind);
    }
    Shape before = is_other ? Shape() : *known;
    before.kind = now.kind;
    write_values(target[to_gltf(now.kind)], now, before, is_other);
  }
}

}  // namespace parian
