#include "scene_io/gltf/gltf.h"

#include <span>
#include <utility>

#include "scene_io/gltf/file/file.h"
#include "scene_io/gltf/file/schema.h"
#include "scene_io/gltf/geometry/decompress.h"
#include "scene_io/gltf/read.h"
#include "scene_io/gltf/source.h"

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

void set_origins(Scene& scene, int file) {
  const auto number = [&](auto& items) {
    for (std::size_t i = 0; i < items.size(); ++i) items[i].origin = {file, int(i)};
  };
  number(scene.nodes);
  number(scene.meshes);
  for (Mesh& mesh : scene.meshes) number(mesh.primitives);
  number(scene.shapes);
  number(scene.materials);
  number(scene.textures);
  number(scene.images);
  number(scene.cameras);
  number(scene.lights);
  scene.environment.origin = {file, 0};
}

std::vector<int> drawn_primitives(const tinygltf::Mesh& mesh) {
  std::vector<int> drawn;
  for (std::size_t p = 0; p < mesh.primitives.size(); ++p)
    if (is_drawn(mesh.primitives[p])) drawn.push_back(int(p));
  return drawn;
}

/// Of a document whose buffers that are not of the file itself have been taken off.
GltfSource make_source(const GltfDocument& document, std::string_view text, const Scene& scene,
                       const Pose& pose, const UsedTextures& used, const DeformedMeshes& deformed) {
  GltfSource source;
  source.path = document.file;
  source.json = text;
  source.buffers = document.buffers;
  source.storage = document.storage;
  source.loaded = scene;
  source.textures = used.textures;
  source.images = used.images;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    const auto made = deformed.source.find(int(m));
    source.deformed.push_back(made != deformed.source.end());
    source.meshes.push_back(source.deformed.back() ? made->second : int(m));
    source.primitives.push_back(drawn_primitives(document.model.meshes[std::size_t(source.meshes.back())]));
  }
  source.shown = deformed.shown;
  source.nodes = document.model.nodes.size();
  source.punctual_lights = std::size_t(punctual_count(document));
  for (const auto& [node, posed] : pose) source.posed[node] = posed.weights.value_or(std::vector<float>());
  return source;
}

}  // namespace

Scene load_gltf(const std::string& path, const LoadSettings& settings, std::vector<std::string>& warnings) {
  const auto begin = [&](const char* phase) {
    if (settings.on_phase) settings.on_phase(phase);
  };
  begin("reading");
  GltfDocument document = read_document(path);
  const std::size_t own_buffers = document.buffers.size();
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
  const UsedTextures used = read_materials(document, settings, scene, notes);
  begin("decoding meshes");
  read_meshes(document, accessors, scene, notes);
  read_cameras(document, scene, notes);
  read_lights(document, scene);
  read_shapes(document, scene);
  const Pose pose = settings.at ? read_pose(document, accessors, *settings.at) : Pose{};
  if (settings.at && document.model.animations.empty()) notes.add("there are no animations");
  read_nodes(document, accessors, pose, scene);
  const DeformedMeshes deformed = deform_meshes(document, accessors, pose, scene);
  begin("checking");
  validate(scene, path);
  set_origins(scene, settings.sources ? int(settings.sources->size()) : settings.file);
  if (settings.sources) {
    document.buffers.resize(own_buffers);
    const SharedArray<std::byte>& bytes = document.storage.front();
    const std::string_view text = split_gltf({bytes.data(), bytes.size()}, path).json;
    settings.sources->push_back(make_source(document, text, scene, pose, used, deformed));
  } else {
    release_unused(document, scene);
  }
  return scene;
}

}  // namespace parian
