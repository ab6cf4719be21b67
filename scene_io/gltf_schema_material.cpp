/// The schema of materials, and the rules for them that a schema cannot say.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <string>
#include <utility>

#include "renderer/base/error.h"
#include "scene_io/gltf_schema.h"
#include "scene_io/metals.h"

namespace parian {
namespace {

constexpr double kMaxInt = 2147483647;  // what tinygltf holds in an int

/// A textureInfo: the reference to a texture, with what `more` members its place in the material adds.
Field texture(std::string key, std::vector<Field> more = {}) {
  Field field = object(
      std::move(key),
      {index("index", "/textures").required(), integer("texCoord").between(0, kMaxInt),
       object("extensions",
              {object("KHR_texture_transform", {numbers("offset", 2), number("rotation"), numbers("scale", 2),
                                                integer("texCoord").between(0, kMaxInt)})})});
  for (Field& member : more) field.fields.push_back(std::move(member));
  return field;
}

Field factor(std::string key) { return number(std::move(key)).between(0, 1); }
Field color(std::string key) { return numbers(std::move(key), 3).between(0, 1); }

/// Ranges as the schemas of the extensions have them.
Field material_extensions() {
  return object(
      "extensions",
      {object("KHR_materials_emissive_strength", {number("emissiveStrength").at_least(0)}),
       object("KHR_materials_ior", {number("ior").at_least(0)}),
       object("KHR_materials_specular",
              {factor("specularFactor"), texture("specularTexture"),
               numbers("specularColorFactor", 3).at_least(0), texture("specularColorTexture")}),
       object("KHR_materials_unlit", {}),
       object("KHR_materials_transmission", {factor("transmissionFactor"), texture("transmissionTexture")}),
       object("KHR_materials_volume", {number("thicknessFactor").at_least(0), texture("thicknessTexture"),
                                       number("attenuationDistance").positive(), color("attenuationColor")}),
       object("KHR_materials_dispersion", {number("dispersion").at_least(0)}),
       object("KHR_materials_diffuse_transmission",
              {factor("diffuseTransmissionFactor"), texture("diffuseTransmissionTexture"),
               color("diffuseTransmissionColorFactor"), texture("diffuseTransmissionColorTexture")}),
       object("KHR_materials_clearcoat",
              {factor("clearcoatFactor"), texture("clearcoatTexture"), factor("clearcoatRoughnessFactor"),
               texture("clearcoatRoughnessTexture"), texture("clearcoatNormalTexture", {number("scale")})}),
       object("KHR_materials_sheen", {color("sheenColorFactor"), texture("sheenColorTexture"),
                                      factor("sheenRoughnessFactor"), texture("sheenRoughnessTexture")}),
       object("KHR_materials_anisotropy",
              {factor("anisotropyStrength"), number("anisotropyRotation"), texture("anisotropyTexture")}),
       object("KHR_materials_iridescence",
              {factor("iridescenceFactor"), texture("iridescenceTexture"),
               number("iridescenceIor").at_least(1), number("iridescenceThicknessMinimum").at_least(0),
               number("iridescenceThicknessMaximum").at_least(0), texture("iridescenceThicknessTexture")}),
       object("PARIAN_materials_phong", {color("diffuse").required(), color("specular").required(),
                                         number("exponent").at_least(0).required()}),
       object("PARIAN_materials_conductor",
              {text("name", metal_names()), numbers("eta", 3).at_least(0), numbers("k", 3).at_least(0)}),
       object("PARIAN_materials_priority", {integer("priority").between(-kMaxInt, kMaxInt)})});
}

void check_ior(const nlohmann::json& extension, const std::string& where, const std::string& file) {
  const double ior = extension.value("ior", 1.5);
  if (ior != 0 && ior < 1) throw InputError(file, where + "/ior", "expected 0 or a number of at least 1");
}

void check_conductor(const nlohmann::json& extension, const std::string& where, const std::string& file) {
  const bool is_named = extension.contains("name");
  for (const char* key : {"eta", "k"}) {
    const std::string place = fmt::format("{}/{}", where, key);
    if (is_named && extension.contains(key))
      throw InputError(file, place, "expected no such member, since name says which metal it is");
    if (!is_named && !extension.contains(key))
      throw InputError(file, place, "expected 3 numbers, each of at least 0, since there is no name");
  }
}

}  // namespace

Field material_fields() {
  return list("materials", {text("name"),
                            object("pbrMetallicRoughness",
                                   {numbers("baseColorFactor", 4).between(0, 1), texture("baseColorTexture"),
                                    factor("metallicFactor"), factor("roughnessFactor"),
                                    texture("metallicRoughnessTexture")}),
                            texture("normalTexture", {number("scale")}), color("emissiveFactor"),
                            texture("emissiveTexture"), text("alphaMode", {"OPAQUE", "MASK", "BLEND"}),
                            number("alphaCutoff").at_least(0), flag("doubleSided"), material_extensions()});
}

void check_materials(const nlohmann::json& document, const std::string& file) {
  if (!document.contains("materials")) return;
  const nlohmann::json& materials = document["materials"];
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!materials[i].contains("extensions")) continue;
    const nlohmann::json& extensions = materials[i]["extensions"];
    const auto check = [&](const char* name, const auto& rule) {
      if (extensions.contains(name))
        rule(extensions[name], fmt::format("/materials/{}/extensions/{}", i, name), file);
    };
    check("KHR_materials_ior", check_ior);
    check("PARIAN_materials_conductor", check_conductor);
    if (extensions.contains("PARIAN_materials_phong") && extensions.contains("PARIAN_materials_conductor")) {
      throw InputError(file, fmt::format("/materials/{}/extensions/PARIAN_materials_phong", i),
                       "expected no such member beside PARIAN_materials_conductor");
    }
  }
}

}  // namespace parian
