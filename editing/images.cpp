#include "editing/images.h"

#include <algorithm>

namespace parian::edit {

int find_or_add_image(Scene& scene, const Image& image) {
  const auto known = std::ranges::find(scene.images, image);
  const int index = int(known - scene.images.begin());
  if (known == scene.images.end()) scene.images.push_back(Image(image));
  return index;
}

}  // namespace parian::edit
