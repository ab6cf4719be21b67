#include "scene_io/gltf.h"

#include "scene_io/gltf_read.h"
#include "scene_io/gltf_schema.h"

namespace parian {

Scene load_gltf(const std::string& path, const LoadSettings& settings, std::vector<std::string>& warnings) {
  const auto begin = [&](const char* phase) {
    if (settings.on_phase) settings.on_phase(phase);
  };
  begin("reading");
  const GltfDocument document = read_document(path);
  Warnings notes(path, warnings);
  for (const std::string& name : document.model.extensionsUsed) {
    if (!reads_extension(name)) notes.add(name + " is not supported and is ignored");
  }
  Scene scene;
  AccessorReader accessors(document);
  begin("decoding images");
  read_materials(document, settings, scene, notes);
  begin("decoding meshes");
  read_meshes(document, accessors, scene, notes);
  read_cameras(document, scene, notes);
  read_lights(document, scene);
  read_shapes(document, scene);
  read_nodes(document, accessors, scene, notes);
  begin("checking");
  validate(scene, path);
  return scene;
}

}  // namespace parian
