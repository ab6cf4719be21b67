/// write_lights().
#include <string>

#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

const char* to_gltf(LightKind kind) {
  switch (kind) {
    case LightKind::point:
      return "point";
    case LightKind::spot:
      return "spot";
    case LightKind::directional:
      return "directional";
    case LightKind::rectangle:
      return "rect";
    case LightKind::disk:
      return "disk";
  }
  return "";
}

bool is_area(LightKind kind) { return kind == LightKind::rectangle || kind == LightKind::disk; }

void write_spot(json& target, const Light& now, const Light& before) {
  json& cone = target["spot"];
  if (!cone.is_object()) cone = json::object();
  set_changed(cone, "innerConeAngle", now.inner_angle, before.inner_angle);
  set_changed(cone, "outerConeAngle", now.outer_angle, before.outer_angle);
}

/// The reader's width is size times aspect, in double precision, of the size that is written in decimals: the
/// quotient of that gives back the float.
void write_size(json& target, const Light& now, const Light& before) {
  if (now.kind == LightKind::disk) {
    set_changed(target, "size", now.width, before.width);
    return;
  }
  set_changed(target, "size", now.height, before.height);
  if (now.width == before.width && now.height == before.height) return;
  if (now.width == now.height)
    target.erase("rect");
  else
    target["rect"]["aspect"] = double(now.width) / target.value("size", 1.0);
}

}  // namespace

void write_lights(Draft& draft) {
  for (std::size_t i = 0; i < draft.scene.lights.size(); ++i) {
    const Light& now = draft.scene.lights[i];
    const bool area = is_area(now.kind);
    json& target =
        need_array(draft.root, area ? array::kAreaLights : array::kLights)[std::size_t(draft.lights[i])];
    const Light* const known = draft.before(&Scene::lights, now.origin);
    // What an empty object of the extension reads as; a light that was of the other extension starts there.
    Light before;
    before.kind = now.kind;
    if (area) before.intensity = 1000;
    const bool is_new = !known || is_area(known->kind) != area;
    if (!is_new) before = *known;
    if (is_new || now.kind != before.kind) {
      target["type"] = to_gltf(now.kind);
      target.erase("spot");
      target.erase("rect");
      before.kind = now.kind;
      before.inner_angle = Light().inner_angle;
      before.outer_angle = Light().outer_angle;
      before.width = before.height;  // without an aspect
    }
    set_name(target, now.name, before.name);
    set_changed(target, "color", now.color, before.color);
    set_changed(target, "intensity", now.intensity, before.intensity);
    if (area) {
      write_size(target, now, before);
    } else {
      set_or_erase(target, "range", now.range, before.range, 0.0f);
      if (now.kind == LightKind::spot) write_spot(target, now, before);
    }
  }
}

}  // namespace parian
