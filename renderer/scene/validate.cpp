#include <algorithm>
#include <limits>
#include <string>

#include "renderer/scene/check.h"
#include "renderer/scene/scene.h"

namespace parian {
namespace {

void check_image(const Image& image, const std::string& where, const Check& check) {
  if (image.width < 1 || image.height < 1) check.fail(where, "expected a size of at least 1 x 1");
  if (image.channels < 1 || image.channels > 4) check.fail(where, "expected 1 to 4 channels");
  const std::size_t expected = image.source ? 0 : image_bytes(image);
  if (image.pixels.size() != expected)
    check.fail(where + "/pixels", fmt::format("expected {} bytes", expected));
}

void check_shape(const Shape& shape, const std::string& where, const Check& check) {
  switch (shape.kind) {
    case ShapeKind::sphere:
      check.positive(shape.radius, where + "/radius");
      break;
    case ShapeKind::cylinder:
      check.not_negative(shape.radius_bottom, where + "/radius_bottom");
      check.not_negative(shape.radius_top, where + "/radius_top");
      check.positive(std::max(shape.radius_bottom, shape.radius_top), where + "/radius_top");
      check.positive(shape.height, where + "/height");
      break;
    case ShapeKind::box:
    case ShapeKind::plane:
      check.positive(shape.size.x, where + "/size");
      if (shape.kind == ShapeKind::box) check.positive(shape.size.y, where + "/size");
      check.positive(shape.size.z, where + "/size");
  }
}

void check_camera(const Camera& camera, const std::string& where, const Check& check) {
  if (camera.projection == Projection::perspective) {
    check.range(camera.yfov, 1e-6f, std::nextafter(kPi, 0.0f), where + "/yfov");
    check.not_negative(camera.aspect, where + "/aspect");
  } else {
    check.positive(camera.xmag, where + "/xmag");
    check.positive(camera.ymag, where + "/ymag");
  }
  check.not_negative(camera.znear, where + "/znear");
  check.not_negative(camera.zfar, where + "/zfar");
  if (!camera.lens) return;
  check.positive(camera.lens->focal_length, where + "/lens/focal_length");
  check.positive(camera.lens->f_stop, where + "/lens/f_stop");
  check.positive(camera.lens->focus_distance, where + "/lens/focus_distance");
  for (const float side : camera.lens->sensor_size) check.positive(side, where + "/lens/sensor_size");
}

void check_light(const Light& light, const std::string& where, const Check& check) {
  check.color(light.color, std::numeric_limits<float>::max(), where + "/color");
  check.not_negative(light.intensity, where + "/intensity");
  check.not_negative(light.range, where + "/range");
  if (light.kind == LightKind::spot) {
    check.range(light.outer_angle, std::numeric_limits<float>::min(), kPi / 2, where + "/outer_angle");
    check.range(light.inner_angle, 0, std::nextafter(light.outer_angle, 0.0f), where + "/inner_angle");
  }
  if (light.kind == LightKind::rectangle || light.kind == LightKind::disk) {
    check.positive(light.width, where + "/width");
    check.positive(light.height, where + "/height");
  }
}

void check_environment(const Scene& scene, const Check& check) {
  check.color(scene.environment.radiance, std::numeric_limits<float>::max(), "/environment/radiance");
  check.optional_index(scene.environment.image, scene.images.size(), "/environment/image");
  check.rotation(scene.environment.rotation, "/environment/rotation");
}

}  // namespace

void validate(const Scene& scene, const std::string& file) {
  const Check check(file);
  check.each("images", scene.images,
             [&](const Image& image, const std::string& where) { check_image(image, where, check); });
  check.each("textures", scene.textures, [&](const Texture& texture, const std::string& where) {
    check.index(texture.image, scene.images.size(), where + "/image");
  });
  validate_materials(scene, check);
  validate_meshes(scene, check);
  check.each("shapes", scene.shapes,
             [&](const Shape& shape, const std::string& where) { check_shape(shape, where, check); });
  check.each("cameras", scene.cameras,
             [&](const Camera& camera, const std::string& where) { check_camera(camera, where, check); });
  check.each("lights", scene.lights,
             [&](const Light& light, const std::string& where) { check_light(light, where, check); });
  validate_nodes(scene, check);
  check_environment(scene, check);
}

}  // namespace parian
