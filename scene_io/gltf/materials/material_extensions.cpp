/// read_material_extensions().
#include "scene_io/gltf/materials/material_extensions.h"

#include "renderer/scene/half_space.h"
#include "scene_io/metals.h"
#include "scene_io/scattering_materials.h"

namespace parian {
namespace {

using tinygltf::Value;

float real_or(const Value& extension, const char* key, float fallback) {
  return float(number_or(extension, key, fallback));
}

Rgb rgb_or(const Value& extension, const char* key, const Rgb& fallback) {
  return to_rgb(numbers_or(extension, key, {fallback.x, fallback.y, fallback.z}));
}

// What the file leaves out keeps the value that the struct has, which is the extension's default.

Transmission read_transmission(const Value& source, TextureTable& textures) {
  Transmission t;
  t.factor = real_or(source, "transmissionFactor", t.factor);
  t.texture = textures.use(source, "transmissionTexture");
  return t;
}

// Without thicknessTexture: a path's own length in the volume is known.
Volume read_volume(const Value& source) {
  Volume v;
  v.thickness = real_or(source, "thicknessFactor", v.thickness);
  v.attenuation_color = rgb_or(source, "attenuationColor", v.attenuation_color);
  v.attenuation_distance = real_or(source, "attenuationDistance", v.attenuation_distance);
  return v;
}

VolumeScatter read_scatter(const Value& source) {
  VolumeScatter v;
  v.multiscatter_color = rgb_or(source, "multiscatterColor", v.multiscatter_color);
  v.anisotropy = real_or(source, "scatterAnisotropy", v.anisotropy);
  return v;
}

DiffuseTransmission read_diffuse_transmission(const Value& source, TextureTable& textures) {
  DiffuseTransmission d;
  d.factor = real_or(source, "diffuseTransmissionFactor", d.factor);
  d.color = rgb_or(source, "diffuseTransmissionColorFactor", d.color);
  d.texture = textures.use(source, "diffuseTransmissionTexture");
  d.color_texture = textures.use(source, "diffuseTransmissionColorTexture");
  return d;
}

Clearcoat read_clearcoat(const Value& source, TextureTable& textures) {
  Clearcoat c;
  c.factor = real_or(source, "clearcoatFactor", c.factor);
  c.roughness = real_or(source, "clearcoatRoughnessFactor", c.roughness);
  c.texture = textures.use(source, "clearcoatTexture");
  c.roughness_texture = textures.use(source, "clearcoatRoughnessTexture");
  c.normal_texture = textures.use(source, "clearcoatNormalTexture");
  if (source.Has("clearcoatNormalTexture"))
    c.normal_scale = real_or(source.Get("clearcoatNormalTexture"), "scale", c.normal_scale);
  return c;
}

SheenModel read_sheen(const Value& source, TextureTable& textures) {
  SheenModel s;
  s.color = rgb_or(source, "sheenColorFactor", s.color);
  s.roughness = real_or(source, "sheenRoughnessFactor", s.roughness);
  s.color_texture = textures.use(source, "sheenColorTexture");
  s.roughness_texture = textures.use(source, "sheenRoughnessTexture");
  return s;
}

Anisotropy read_anisotropy(const Value& source, TextureTable& textures) {
  Anisotropy a;
  a.strength = real_or(source, "anisotropyStrength", a.strength);
  a.rotation = real_or(source, "anisotropyRotation", a.rotation);
  a.texture = textures.use(source, "anisotropyTexture");
  return a;
}

Iridescence read_iridescence(const Value& source, TextureTable& textures) {
  Iridescence i;
  i.factor = real_or(source, "iridescenceFactor", i.factor);
  i.ior = real_or(source, "iridescenceIor", i.ior);
  i.thickness_minimum = real_or(source, "iridescenceThicknessMinimum", i.thickness_minimum);
  i.thickness_maximum = real_or(source, "iridescenceThicknessMaximum", i.thickness_maximum);
  i.texture = textures.use(source, "iridescenceTexture");
  i.thickness_texture = textures.use(source, "iridescenceThicknessTexture");
  return i;
}

PhongModel read_phong(const Value& source) {
  PhongModel p;
  p.diffuse = rgb_or(source, "diffuse", p.diffuse);
  p.specular = rgb_or(source, "specular", p.specular);
  p.exponent = real_or(source, "exponent", p.exponent);
  return p;
}

ConductorModel read_conductor(const Value& source) {
  if (const auto metal = find_metal(text_or(source, "name", ""))) return *metal;
  ConductorModel c;
  c.eta = rgb_or(source, "eta", c.eta);
  c.k = rgb_or(source, "k", c.k);
  return c;
}

ScatteringMaterial read_scattering_material(const Value& source) {
  if (const auto known = find_scattering_material(text_or(source, "name", ""))) return *known;
  ScatteringMaterial m;
  m.reduced_scattering = rgb_or(source, "sigmaSPrime", m.reduced_scattering);
  m.absorption = rgb_or(source, "sigmaA", m.absorption);
  m.eta = real_or(source, "eta", m.eta);
  if (!source.Has("color")) return m;
  const Rgb color = rgb_or(source, "color", {}), path = rgb_or(source, "meanFreePath", {});
  for (int k = 0; k < 3; ++k) {
    const double albedo = half_space_albedo(color[k], m.eta);
    m.reduced_scattering[k] = float(albedo / path[k]);
    m.absorption[k] = float((1 - albedo) / path[k]);
  }
  return m;
}

/// Its model and index of refraction.
void read_subsurface(const Value& source, Material& material) {
  const ScatteringMaterial m = read_scattering_material(source);
  const float per_metre = float(1000 / number_or(source, "scale", 1));
  material.subsurface = SubsurfaceModel{m.absorption * per_metre, m.reduced_scattering * per_metre};
  material.ior = m.eta;
}

}  // namespace

void read_material_extensions(const tinygltf::ExtensionMap& extensions, TextureTable& textures,
                              Material& material) {
  const auto find = [&](const char* name) { return find_extension(extensions, name); };
  if (const auto* e = find("KHR_materials_emissive_strength"))
    material.emission *= real_or(*e, "emissiveStrength", 1);
  if (const auto* e = find("KHR_materials_ior")) material.ior = real_or(*e, "ior", material.ior);
  if (const auto* e = find("KHR_materials_specular")) {
    material.specular = real_or(*e, "specularFactor", material.specular);
    material.specular_color = rgb_or(*e, "specularColorFactor", material.specular_color);
    material.specular_texture = textures.use(*e, "specularTexture");
    material.specular_color_texture = textures.use(*e, "specularColorTexture");
  }
  material.unlit = find("KHR_materials_unlit") != nullptr;
  if (const auto* e = find("KHR_materials_transmission"))
    material.transmission = read_transmission(*e, textures);
  if (const auto* e = find("KHR_materials_volume")) material.volume = read_volume(*e);
  if (const auto* e = find("KHR_materials_volume_scatter")) material.scatter = read_scatter(*e);
  if (const auto* e = find("KHR_materials_diffuse_transmission"))
    material.diffuse_transmission = read_diffuse_transmission(*e, textures);
  if (const auto* e = find("KHR_materials_clearcoat")) material.clearcoat = read_clearcoat(*e, textures);
  if (const auto* e = find("KHR_materials_sheen")) material.sheen = read_sheen(*e, textures);
  if (const auto* e = find("KHR_materials_anisotropy")) material.anisotropy = read_anisotropy(*e, textures);
  if (const auto* e = find("KHR_materials_iridescence"))
    material.iridescence = read_iridescence(*e, textures);
  if (const auto* e = find("KHR_materials_dispersion"))
    material.dispersion = real_or(*e, "dispersion", material.dispersion);
  if (const auto* e = find("PARIAN_materials_phong")) material.phong = read_phong(*e);
  if (const auto* e = find("PARIAN_materials_conductor")) material.conductor = read_conductor(*e);
  if (const auto* e = find("PARIAN_materials_subsurface")) read_subsurface(*e, material);
  if (const auto* e = find("PARIAN_materials_priority"))
    material.priority = int(number_or(*e, "priority", material.priority));
}

}  // namespace parian
