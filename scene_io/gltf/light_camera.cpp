/// read_cameras() and read_lights().
#include <algorithm>
#include <utility>

#include "scene_io/gltf/read.h"

namespace parian {
namespace {

void read_lens(const tinygltf::Value& source, Camera& camera, Warnings& warnings) {
  // Without an f-number the extension only documents the sensor: a pinhole.
  if (!source.Has("fStop")) return;
  const double distance = number_or(source, "focusDistance", 0);
  if (distance <= 0) {
    warnings.add("cameras with fStop but no focusDistance above 0 are taken as pinholes");
    return;
  }
  const auto sensor = numbers_or(source, "sensorSize", {});
  camera.lens = Lens{.focal_length = float(number_or(source, "focalLength", 0)),
                     .f_stop = float(number_or(source, "fStop", 0)),
                     .focus_distance = float(distance),
                     .sensor_size = {float(sensor[0]), float(sensor[1])}};
}

void read_common(const tinygltf::Value& source, double default_intensity, Light& light) {
  light.name = text_or(source, "name", "");
  const auto color = numbers_or(source, "color", {1, 1, 1});
  light.color = {float(color[0]), float(color[1]), float(color[2])};
  light.intensity = float(number_or(source, "intensity", default_intensity));
}

Light read_punctual(const tinygltf::Value& source, const GltfDocument& document, const std::string& where) {
  Light light;
  read_common(source, 1, light);
  const std::string type = text_or(source, "type", "");
  light.kind = type == "spot" ? LightKind::spot : type == "point" ? LightKind::point : LightKind::directional;
  light.range = float(number_or(source, "range", 0));
  if (light.kind == LightKind::spot) {
    // tinygltf drops an empty object, which stands for the default angles.
    const tinygltf::Value spot = source.Has("spot") ? source.Get("spot") : tinygltf::Value();
    light.inner_angle = float(number_or(spot, "innerConeAngle", 0));
    light.outer_angle = float(number_or(spot, "outerConeAngle", kPi / 4));
    if (!(light.inner_angle < light.outer_angle)) {
      document.fail(where + "/spot/innerConeAngle", "expected an angle below outerConeAngle");
    }
  }
  return light;
}

Light read_area(const tinygltf::Value& source) {
  Light light;
  read_common(source, 1000, light);
  const bool is_disk = text_or(source, "type", "") == "disk";
  const double size = number_or(source, "size", 1);
  const double aspect = !is_disk && source.Has("rect") ? number_or(source.Get("rect"), "aspect", 1) : 1;
  light.kind = is_disk ? LightKind::disk : LightKind::rectangle;
  light.width = float(size * aspect);
  light.height = float(size);
  return light;
}

const tinygltf::Value::Array* find_lights(const GltfDocument& document, const std::string& extension) {
  const auto* value = find_extension(document.model.extensions, extension);
  return value && value->Has("lights") ? &value->Get("lights").Get<tinygltf::Value::Array>() : nullptr;
}

}  // namespace

void read_cameras(const GltfDocument& document, Scene& scene, Warnings& warnings) {
  for (const tinygltf::Camera& source : document.model.cameras) {
    Camera camera;
    camera.name = source.name;
    if (source.type == "orthographic") {
      camera.projection = Projection::orthographic;
      camera.xmag = float(source.orthographic.xmag);
      camera.ymag = float(source.orthographic.ymag);
      camera.znear = float(source.orthographic.znear);
      camera.zfar = float(source.orthographic.zfar);
    } else {
      camera.yfov = float(source.perspective.yfov);
      camera.aspect = float(source.perspective.aspectRatio);
      camera.znear = float(source.perspective.znear);
      camera.zfar = float(source.perspective.zfar);
      const auto* physical = find_extension(source.extensions, "EXT_camera_physical");
      if (physical) read_lens(*physical, camera, warnings);
    }
    scene.cameras.push_back(std::move(camera));
  }
}

void read_lights(const GltfDocument& document, Scene& scene) {
  if (const auto* lights = find_lights(document, "KHR_lights_punctual")) {
    for (std::size_t i = 0; i < lights->size(); ++i) {
      const std::string where = fmt::format("/extensions/KHR_lights_punctual/lights/{}", i);
      scene.lights.push_back(read_punctual((*lights)[i], document, where));
    }
  }
  if (const auto* lights = find_lights(document, "EXT_lights_area")) {
    for (const auto& light : *lights) scene.lights.push_back(read_area(light));
  }
}

}  // namespace parian
