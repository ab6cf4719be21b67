/// write_cameras().
#include <algorithm>
#include <limits>
#include <string>

#include "scene_io/gltf/write/draft.h"
#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

constexpr float kTiny = std::numeric_limits<float>::min();

const char* to_gltf(Projection projection) {
  return projection == Projection::orthographic ? "orthographic" : "perspective";
}

/// All that glTF requires is written where `all`, and what has changed.
void write_projection(json& values, const Camera& now, const Camera& before, bool all) {
  const auto set = [&](const char* key, float value, float old) {
    if (all || value != old) values[key] = to_json(value);
  };
  // glTF has the far plane behind the near one; that a perspective camera has none may be left unsaid.
  const bool has_far = now.zfar > now.znear;
  if (now.projection == Projection::orthographic) {
    set("xmag", now.xmag, before.xmag);
    set("ymag", now.ymag, before.ymag);
    set("znear", now.znear, before.znear);
    const float far_plane = has_far ? now.zfar : now.znear * 2 + 1000;
    if (all || now.zfar != before.zfar || now.znear != before.znear) values["zfar"] = to_json(far_plane);
    return;
  }
  set("yfov", now.yfov, before.yfov);
  set("znear", std::max(now.znear, kTiny), std::max(before.znear, kTiny));
  if (all || now.aspect != before.aspect) {
    values.erase("aspectRatio");
    if (now.aspect > 0) values["aspectRatio"] = to_json(now.aspect);
  }
  if (all || now.zfar != before.zfar || now.znear != before.znear) {
    values.erase("zfar");
    if (has_far) values["zfar"] = to_json(now.zfar);
  }
}

void write_lens(json& target, const Camera& now, const Camera& before) {
  if (now.lens == before.lens || now.projection == Projection::orthographic) return;
  if (!now.lens) {
    // Without it the extension speaks of the sensor alone.
    need_extension(target, "EXT_camera_physical").erase("fStop");
    return;
  }
  json& lens = need_extension(target, "EXT_camera_physical");
  lens["focalLength"] = to_json(now.lens->focal_length);
  lens["fStop"] = to_json(now.lens->f_stop);
  lens["focusDistance"] = to_json(now.lens->focus_distance);
  lens["sensorSize"] = {to_json(now.lens->sensor_size[0]), to_json(now.lens->sensor_size[1])};
}

}  // namespace

void write_cameras(Draft& draft) {
  const Camera none;
  for (std::size_t i = 0; i < draft.scene.cameras.size(); ++i) {
    const Camera& now = draft.scene.cameras[i];
    const Camera* const known = draft.before(&Scene::cameras, now.origin);
    const Camera& before = known ? *known : none;
    json& target = need_array(draft.root, array::kCameras)[i];
    set_name(target, now.name, before.name);
    const bool is_other = !known || now.projection != before.projection;
    if (is_other) {
      target.erase(to_gltf(before.projection));
      target["type"] = to_gltf(now.projection);
    }
    write_projection(target[to_gltf(now.projection)], now, before, is_other);
    write_lens(target, now, before);
  }
}

}  // namespace parian
