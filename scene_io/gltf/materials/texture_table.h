/// The textures and images that a document's materials and environment use.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/scene.h"
#include "scene_io/gltf/file/document.h"

namespace parian {

/// Collects the textures and images in use, in the order in which they are first asked for.
class TextureTable {
 public:
  TextureTable(const GltfDocument& document, Scene& scene, Warnings& warnings)
      : document_(document), scene_(scene), warnings_(warnings) {}

  /// The scene's index of an image of the document. Images with the same source are one.
  int use_image(int image);

  /// A texture of the core material.
  template <class Info>
  TextureRef use(const Info& info) {
    return use(info.index, info.texCoord, info.extensions);
  }

  /// A texture inside a material extension.
  TextureRef use(const tinygltf::Value& extension, const char* key);

  /// The images in use, as indices into the document's.
  const std::vector<int>& images() const { return images_; }
  /// The same of textures.
  const std::vector<int>& textures() const { return textures_; }

 private:
  TextureRef use(int texture, int uv_set, const tinygltf::ExtensionMap& extensions);
  int use_texture(int number);

  const GltfDocument& document_;
  Scene& scene_;
  Warnings& warnings_;
  std::map<int, int> texture_of_;
  std::map<std::pair<std::string, int>, int> image_of_;
  std::vector<int> images_, textures_;
};

}  // namespace parian
