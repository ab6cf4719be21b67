/// What a glTF document may look like: names, types, ranges and indices, before anything reads it.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

#include "scene_io/gltf/file/field.h"

namespace parian {

/// The members of a glTF document that Parian reads, with those of the extensions that it reads.
std::vector<Field> document_fields();

/// Of these, the materials.
Field material_fields();

/// And skins and animations.
Field skin_fields();
Field animation_fields();

/// The rules for materials that fields cannot say, of a document that its fields have passed. Throws
/// InputError.
void check_materials(const nlohmann::json& document, const std::string& file);

/// The rules for compressed bufferViews and primitives that fields cannot say, of a document that its fields
/// have passed. Accessors of compressed primitives lose what else they say of where their elements lie.
/// Throws InputError.
void check_compression(nlohmann::json& document, const std::string& file);
/// The same for animations; a channel without a node gets node -1. Throws InputError.
void check_animations(nlohmann::json& document, const std::string& file);

/// Whether Parian reads the glTF extension of this name.
bool reads_extension(const std::string& name);

/// Checks the document and reduces it to what Parian reads: afterwards every member is of the type that glTF
/// gives it and in its range, every index is inside the array it points into, integers are stored as integers
/// and other numbers as finite doubles, and members, extras and extensions that are not read are gone. Throws
/// InputError naming the JSON path and what was expected there.
void conform(nlohmann::json& document, const std::string& file);

}  // namespace parian
