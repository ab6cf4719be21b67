/// The document that write_gltf() makes, between its parts.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene_io/gltf/source.h"
#include "scene_io/gltf/write/new_data.h"
#include "scene_io/gltf/write/references.h"

namespace parian {

struct Draft {
  const Scene& scene;
  std::span<const GltfSource> sources;
  std::filesystem::path path, folder;
  bool is_glb;

  nlohmann::json root;
  std::vector<std::span<const std::byte>> buffers;        // of root's, the bytes
  std::vector<std::map<std::string, std::size_t>> first;  // by source: where its elements begin in root's
                                                          // arrays; empty where nothing is of it
  std::vector<std::map<std::string, std::size_t>> count;  // and how many they are
  std::vector<int> default_scene;                         // by source: in root, or kNone
  bool has_default_scene = false;                         // the first source that there is something of
  NewData data;

  // Numbers in root by number in the scene.
  std::vector<int> textures, images, lights;

  /// What an element of the scene was when it was loaded; nullptr where it was made here.
  template <class T>
  const T* before(const std::vector<T> Scene::*items, const Origin& origin) const {
    const GltfSource* const source = source_of(origin);
    if (!source || origin.index < 0) return nullptr;
    const std::vector<T>& loaded = source->loaded.*items;
    return std::size_t(origin.index) < loaded.size() ? &loaded[std::size_t(origin.index)] : nullptr;
  }
  const GltfSource* source_of(const Origin& origin) const {
    const bool known = origin.file >= 0 && std::size_t(origin.file) < sources.size() &&
                       !first[std::size_t(origin.file)].empty();
    return known ? &sources[std::size_t(origin.file)] : nullptr;
  }
  /// Where element `number` of an array of a source's document was put first.
  int merged(const Origin& origin, const std::string& array, std::size_t number) const {
    return int(first[std::size_t(origin.file)].at(array) + number);
  }
};

/// The documents of all sources that the scene has something of, one behind the other. Uris lead from the new
/// folder.
void merge_sources(Draft& draft);

/// Gives root's arrays the elements of the scene, in its order, each with what its source says of it, and all
/// references their new numbers. What the scene has no longer is gone; what Parian does not read stays.
void arrange(Draft& draft);

// Each writes the values of the scene into its elements in root, where they are not those of the file.
void write_textures(Draft& draft);  // and images
void write_materials(Draft& draft);
void write_meshes_and_nodes(Draft& draft);
void write_cameras(Draft& draft);
void write_lights(Draft& draft);
void write_shapes(Draft& draft);
void write_scenes(Draft& draft);  // the default scene, with the environment

/// Takes out what nothing refers to any more, and did in the sources.
void drop_unused(Draft& draft, const std::map<std::string, std::vector<bool>>& referenced_before);

/// asset, extensionsUsed and extensionsRequired.
void write_header(Draft& draft);

/// Writes the files.
void write_files(Draft& draft);

}  // namespace parian
