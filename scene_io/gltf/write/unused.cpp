/// drop_unused().
#include <algorithm>

#include "scene_io/gltf/file/schema.h"
#include "scene_io/gltf/write/draft.h"

namespace parian {
namespace {

using nlohmann::json;

/// An extension that may refer to anything by numbers that only it knows.
bool has_unknown_extension(const json& root) {
  // Those that refer to nothing, or in ways that for_each_reference() knows.
  static const std::vector<std::string> kHarmless = {"EXT_lights_image_based",
                                                     "EXT_texture_avif",
                                                     "KHR_animation_pointer",
                                                     "KHR_materials_pbrSpecularGlossiness",
                                                     "KHR_materials_variants",
                                                     "KHR_meshopt_compression",
                                                     "KHR_node_hoverability",
                                                     "KHR_node_selectability",
                                                     "KHR_texture_basisu",
                                                     "KHR_xmp_json_ld",
                                                     "MSFT_lod"};
  const json names = root.value("extensionsUsed", json::array());
  return std::ranges::any_of(names, [](const json& name) {
    const std::string text = name;
    return !reads_extension(text) && std::ranges::find(kHarmless, text) == kHarmless.end();
  });
}

}  // namespace

// What nothing has referred to before may be there for an extension, or for later.
void drop_unused(Draft& draft, const std::map<std::string, std::vector<bool>>& referenced_before) {
  if (has_unknown_extension(draft.root)) return;
  // In this order, since what goes first may have been the last to use the others.
  for (const std::string& array : {array::kEnvironments, array::kTextures, array::kSamplers, array::kImages,
                                   array::kAccessors, array::kBufferViews}) {
    std::vector<bool> keep = find_referenced(draft.root).at(array);
    const std::vector<bool>& before = referenced_before.at(array);
    for (std::size_t i = 0; i < before.size() && i < keep.size(); ++i) keep[i] = keep[i] || !before[i];
    if (array == array::kBufferViews) {
      // The pieces of new bytes go with their views: a picture that was added and is not used after all.
      NewData& data = draft.data;
      std::size_t left = 0;
      for (std::size_t i = 0; i < data.pieces.size(); ++i)
        if (keep[data.first_view + i]) std::swap(data.pieces[left++], data.pieces[i]);
      data.pieces.resize(left);
      data.first_view = std::size_t(std::count(keep.begin(), keep.begin() + long(data.first_view), true));
    }
    keep_only(draft.root, array, keep);
  }
}

}  // namespace parian
