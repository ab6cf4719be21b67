#include "scene_io/gltf/gltf.h"

#include <span>
#include <utility>

#include "scene_io/gltf/file/schema.h"
#include "scene_io/gltf/geometry/decompress.h"
#include "scene_io/gltf/read.h"

namespace parian {
namespace {

// Gives back those pages of the files that no mesh reads: JSON, pictures, and what was decoded elsewhere.
void release_unused(const GltfDocument& document, const Scene& scene) {
  std::vector<std::span<const std::byte>> used;
  const auto use = [&](const auto& array) {
    used.push_back(std::as_bytes(std::span(array.data(), array.size())));
  };
  for (const Mesh& mesh : scene.meshes)
    for (const Primitive& p : mesh.primitives) {
      use(p.positions);
      use(p.normals);
      use(p.tangents);
      for (const auto& uvs : p.uvs) use(uvs);
      use(p.colors);
      use(p.triangles);
    }
  for (const auto& pages : document.pages) {
    std::vector<std::span<const std::byte>> parts;
    for (const auto& span : used)
      if (span.data() >= pages->data() && span.data() < pages->data() + pages->size()) parts.push_back(span);
    pages->release_all_but(std::move(parts));
  }
}

}  // namespace

Scene load_gltf(const std::string& path, const LoadSettings& settings, std::vector<std::string>& warnings) {
  const auto begin = [&](const char* phase) {
    if (settings.on_phase) settings.on_phase(phase);
  };
  begin("reading");
  GltfDocument document = read_document(path);
  if (is_compressed(document)) {
    begin("decompressing");
    decompress(document);
  }
  check_document(document);
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
  const Pose pose = settings.at ? read_pose(document, accessors, *settings.at) : Pose{};
  if (settings.at && document.model.animations.empty()) notes.add("there are no animations");
  read_nodes(document, accessors, pose, scene);
  deform_meshes(document, accessors, pose, scene);
  begin("checking");
  validate(scene, path);
  release_unused(document, scene);
  return scene;
}

}  // namespace parian
