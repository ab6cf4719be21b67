/// Scenes written and read again.
#pragma once

#include "scene_io/gltf/source.h"
#include "scene_io/gltf/write/write.h"
#include "tests/scene_io/support/gltf_builder.h"

namespace parian {

/// A scene with what is kept of its files.
struct Loaded {
  Scene scene;
  std::vector<GltfSource> sources;
};

inline Loaded load_with_source(const std::string& path, LoadSettings settings = {}) {
  Loaded loaded;
  std::vector<std::string> warnings;
  settings.sources = &loaded.sources;
  loaded.scene = load_gltf(path, settings, warnings);
  return loaded;
}

/// The JSON of a .gltf or .glb.
inline json document_of(const std::string& path) {
  const std::string bytes = read_bytes(path);
  if (!bytes.starts_with("glTF")) return json::parse(bytes);
  std::uint32_t size;
  std::memcpy(&size, bytes.data() + 12, sizeof(size));
  return json::parse(bytes.substr(20, size));
}

class WriteTest : public GltfTest {
 protected:
  /// Loads what the builder has, with its source.
  Loaded load_source(const GltfBuilder& builder, const LoadSettings& with = {}) {
    return load_with_source(write("source.glb", builder.glb()), with);
  }

  /// Writes, and reads again.
  Loaded again(const Loaded& loaded, const std::string& name = "again.glb") {
    std::filesystem::create_directories(std::filesystem::path(path(name)).parent_path());
    write_gltf(loaded.scene, loaded.sources, path(name));
    return load_with_source(path(name));
  }

  json written(const Loaded& loaded, const std::string& name = "written.glb") {
    write_gltf(loaded.scene, loaded.sources, path(name));
    return document_of(path(name));
  }
};

}  // namespace parian
