/// The numbers by which parts of a glTF document refer to each other.
#pragma once

#include <nlohmann/json.hpp>

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace parian {

/// The arrays of a document that are referred to by number, as JSON pointers.
namespace array {
inline const std::string kAccessors = "/accessors", kBufferViews = "/bufferViews", kBuffers = "/buffers",
                         kCameras = "/cameras", kImages = "/images", kMaterials = "/materials",
                         kMeshes = "/meshes", kNodes = "/nodes", kSamplers = "/samplers", kScenes = "/scenes",
                         kSkins = "/skins", kTextures = "/textures", kAnimations = "/animations",
                         kLights = "/extensions/KHR_lights_punctual/lights",
                         kAreaLights = "/extensions/EXT_lights_area/lights",
                         kEnvironments = "/extensions/EXT_lights_environment/environments",
                         kShapes = "/extensions/KHR_implicit_shapes/shapes";
inline const std::array kAll = {kAccessors, kBufferViews, kBuffers,    kCameras,      kImages, kMaterials,
                                kMeshes,    kNodes,       kSamplers,   kScenes,       kSkins,  kTextures,
                                kLights,    kAnimations,  kAreaLights, kEnvironments, kShapes};
}  // namespace array

/// The array, or nullptr where the document has none.
nlohmann::json* find_array(nlohmann::json& root, const std::string& pointer);
std::size_t array_size(nlohmann::json& root, const std::string& pointer);
/// The array, made where it is missing.
nlohmann::json& need_array(nlohmann::json& root, const std::string& pointer);

/// Called with the array that a number points into and the number, which it may change. False: what it
/// referred to is gone, and the reference goes too, with whatever makes no sense without it: the channel of
/// an animation, the use of a texture. A skin that misses a joint becomes null.
using Visit = std::function<bool(const std::string& array, std::size_t& number)>;

/// Visits all references that core glTF and published extensions have; those of other extensions are not
/// known. Numbers that are none are passed over: Parian does not read all of them, and so has not checked
/// them.
void for_each_reference(nlohmann::json& root, const Visit& visit);

/// By array: for each old number the new one, or kNone where it is gone.
using Numbers = std::map<std::string, std::vector<int>>;

/// Gives all references into these arrays their new numbers.
void renumber(nlohmann::json& root, const Numbers& numbers);

/// Takes the elements out of the array that `keep` does not have, and renumbers.
void keep_only(nlohmann::json& root, const std::string& pointer, const std::vector<bool>& keep);

/// By array, which elements something refers to.
std::map<std::string, std::vector<bool>> find_referenced(nlohmann::json& root);

}  // namespace parian
