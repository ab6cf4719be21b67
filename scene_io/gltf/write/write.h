/// A Scene as a glTF 2.0 file.
#pragma once

#include <span>
#include <string>

#include "scene_io/gltf/source.h"

namespace parian {

/// Writes the scene as .glb, or as .gltf with one .bin beside it, by the extension of `path`. What came from
/// the files that `sources` has (LoadSettings::sources, in that order) keeps all that those say of it, used
/// or not, in the words that they have; values that are no longer those of the file are written anew.
///
/// A scene as loaded from one file reads back equal. Of one that was edited or composed the order of things
/// may be another: punctual lights come before area lights, textures and images in the order of their use,
/// meshes of skins behind all nodes.
///
/// The file appears whole or not at all, and may be one of the sources. Throws InputError naming the path:
/// where it cannot be written, has another extension or would be a .glb of 4 GiB or more; where the scene is
/// not valid; and where an image is neither of a source nor a file.
void write_gltf(const Scene& scene, std::span<const GltfSource> sources, const std::string& path);

}  // namespace parian
