/// The schema of materials.
#include <string>
#include <utility>

#include "scene_io/gltf/file/schema.h"
#include "scene_io/metals.h"
#include "scene_io/scattering_materials.h"

namespace parian {
namespace {

constexpr double kMaxInt = 2147483647;  // what tinygltf holds in an int
// So that a coefficient per millimetre over a scale is far inside the range of a float.
constexpr double kLarge = 1e9;

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
       object("KHR_materials_volume_scatter", {color("multiscatterColor"), number("scatterAnisotropy")}),
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
       object("PARIAN_materials_subsurface",
              {text("name", scattering_material_names()), numbers("sigmaA", 3).between(0, kLarge),
               numbers("sigmaSPrime", 3).between(0, kLarge), color("color"),
               numbers("meanFreePath", 3).between(1 / kLarge, kLarge), number("eta").at_least(1),
               number("scale").between(1 / kLarge, kLarge)}),
       object("PARIAN_materials_priority", {integer("priority").between(-kMaxInt, kMaxInt)})});
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

}  // namespace parian
