#include "editing/environment.h"

#include "editing/arguments.h"
#include "editing/images.h"
#include "images/image_io.h"

namespace parian::edit {

void set_environment_image(Scene& scene, const Image& image) {
  check_element(image);
  scene.environment.image = find_or_add_image(scene, image);
  if (is_black(scene.environment.radiance)) scene.environment.radiance = Rgb(1);
}

void set_environment_image(Scene& scene, const std::string& path) {
  set_environment_image(scene, read_image(path));
}

void remove_environment_image(Scene& scene) {
  if (scene.environment.image == kNone) refuse("environment: expected one with an image");
  scene.environment.image = kNone;
}

}  // namespace parian::edit
