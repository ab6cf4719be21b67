#include "scene_io/gltf/write/write.h"

#include "renderer/base/error.h"
#include "scene_io/gltf/write/draft.h"

namespace parian {

void write_gltf(const Scene& scene, std::span<const GltfSource> sources, const std::string& path) {
  const std::filesystem::path target(path);
  const bool is_glb = target.extension() == ".glb";
  if (!is_glb && target.extension() != ".gltf")
    throw InputError(path, "", "cannot be written: expected a name that ends in .glb or .gltf");
  validate(scene, path);
  Draft draft{.scene = scene,
              .sources = sources,
              .path = target,
              .folder = target.parent_path(),
              .is_glb = is_glb,
              .root = {},
              .buffers = {},
              .first = {},
              .count = {},
              .default_scene = {},
              .data = {},
              .textures = {},
              .images = {},
              .lights = {}};
  merge_sources(draft);
  const auto referenced = find_referenced(draft.root);
  draft.data.first_view = array_size(draft.root, array::kBufferViews);
  arrange(draft);
  write_textures(draft);
  write_materials(draft);
  write_cameras(draft);
  write_lights(draft);
  write_shapes(draft);
  // Before nodes that reading makes again are left out, and the others get their last numbers.
  write_scenes(draft);
  write_meshes_and_nodes(draft);
  drop_unused(draft, referenced);
  write_files(draft);
}

}  // namespace parian
