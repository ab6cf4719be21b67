#include "editing/arguments.h"

#include <utility>

namespace parian::edit {
namespace {

void check_scene(const Scene& scene, const char* what) {
  try {
    validate(scene, what);
  } catch (const InputError& error) {
    refuse(error.what());
  }
}

}  // namespace

void check_element(const Transform& transform) {
  Scene scene;
  scene.nodes.emplace_back().transform = transform;
  check_scene(scene, "transform");
}

void check_element(const Shape& shape) {
  Scene scene;
  scene.shapes.push_back(shape);
  check_scene(scene, "shape");
}

void check_element(Material material) {
  for_each_texture(material, [](TextureRef& use) { use.texture = kNone; });
  Scene scene;
  scene.materials.push_back(std::move(material));
  check_scene(scene, "material");
}

void check_element(const Camera& camera) {
  Scene scene;
  scene.cameras.push_back(camera);
  check_scene(scene, "camera");
}

void check_element(const Light& light) {
  Scene scene;
  scene.lights.push_back(light);
  check_scene(scene, "light");
}

void check_element(const Image& image) {
  Scene scene;
  scene.images.push_back(image);
  check_scene(scene, "image");
}

void check_element(const Environment& environment) {
  Scene scene;
  scene.environment = environment;
  scene.environment.image = kNone;
  check_scene(scene, "environment");
}

}  // namespace parian::edit
