#include "scene_io/gltf/write/material_extensions.h"

#include <cmath>
#include <optional>

#include "scene_io/gltf/write/member.h"

namespace parian {
namespace {

using nlohmann::json;

class ExtensionWriter {
 public:
  ExtensionWriter(json& target, const TextureUses& textures) : target_(target), textures_(textures) {}

  void write(const Material& now, const Material& before) {
    write_interface(now, before);
    group("KHR_materials_transmission", now.transmission, before.transmission,
          [&](json& e, const Transmission& n, const Transmission& b) {
            set_changed(e, "transmissionFactor", n.factor, b.factor);
            textures_.set(e, "transmissionTexture", n.texture, b.texture);
          });
    group("KHR_materials_volume", now.volume, before.volume, [&](json& e, const Volume& n, const Volume& b) {
      set_changed(e, "thicknessFactor", n.thickness, b.thickness);
      set_changed(e, "attenuationColor", n.attenuation_color, b.attenuation_color);
      set_or_erase(e, "attenuationDistance", n.attenuation_distance, b.attenuation_distance, 0.0f);
    });
    group("KHR_materials_volume_scatter", now.scatter, before.scatter,
          [&](json& e, const VolumeScatter& n, const VolumeScatter& b) {
            set_changed(e, "multiscatterColor", n.multiscatter_color, b.multiscatter_color);
            set_changed(e, "scatterAnisotropy", n.anisotropy, b.anisotropy);
          });
    group("KHR_materials_diffuse_transmission", now.diffuse_transmission, before.diffuse_transmission,
          [&](json& e, const DiffuseTransmission& n, const DiffuseTransmission& b) {
            set_changed(e, "diffuseTransmissionFactor", n.factor, b.factor);
            set_changed(e, "diffuseTransmissionColorFactor", n.color, b.color);
            textures_.set(e, "diffuseTransmissionTexture", n.texture, b.texture);
            textures_.set(e, "diffuseTransmissionColorTexture", n.color_texture, b.color_texture);
          });
    write_layers(now, before);
    write_models(now, before);
  }

 private:
  /// A group of values that is there or not, as its extension is.
  template <class Group, class Body>
  void group(const char* name, const std::optional<Group>& now, const std::optional<Group>& before,
             const Body& body) {
    if (now)
      body(need_extension(target_, name), *now, before.value_or(Group{}));
    else if (before)
      erase_extension(target_, name);
  }

  /// One number that is an extension.
  template <class T>
  void single(const char* name, const char* key, const T& now, const T& before) {
    if (!(now == before)) need_extension(target_, name)[key] = to_json(now);
  }

  void write_interface(const Material& now, const Material& before) {
    write_ior(now, before);
    const auto write_specular = [&](json& e) {
      set_changed(e, "specularFactor", now.specular, before.specular);
      set_changed(e, "specularColorFactor", now.specular_color, before.specular_color);
      textures_.set(e, "specularTexture", now.specular_texture, before.specular_texture);
      textures_.set(e, "specularColorTexture", now.specular_color_texture, before.specular_color_texture);
    };
    json* const there = find_extension(target_, "KHR_materials_specular");
    json specular = there ? *there : json::object();
    write_specular(specular);
    if (there || !specular.empty()) need_extension(target_, "KHR_materials_specular") = std::move(specular);
    if (now.unlit && !before.unlit) need_extension(target_, "KHR_materials_unlit");
    if (!now.unlit && before.unlit) erase_extension(target_, "KHR_materials_unlit");
    single("KHR_materials_dispersion", "dispersion", now.dispersion, before.dispersion);
    single("PARIAN_materials_priority", "priority", now.priority, before.priority);
  }

  /// A scattering body has its own index, in place of KHR_materials_ior.
  void write_ior(const Material& now, const Material& before) {
    if (now.subsurface) return;
    float said = before.ior;
    if (before.subsurface) {
      json* const ior = find_extension(target_, "KHR_materials_ior");
      said = ior ? ior->value("ior", 1.5f) : 1.5f;
    }
    single("KHR_materials_ior", "ior", now.ior, said);
  }

  void write_layers(const Material& now, const Material& before) {
    group("KHR_materials_clearcoat", now.clearcoat, before.clearcoat,
          [&](json& e, const Clearcoat& n, const Clearcoat& b) {
            set_changed(e, "clearcoatFactor", n.factor, b.factor);
            set_changed(e, "clearcoatRoughnessFactor", n.roughness, b.roughness);
            textures_.set(e, "clearcoatTexture", n.texture, b.texture);
            textures_.set(e, "clearcoatRoughnessTexture", n.roughness_texture, b.roughness_texture);
            json* const use = textures_.set(e, "clearcoatNormalTexture", n.normal_texture, b.normal_texture);
            if (use) set_changed(*use, "scale", n.normal_scale, b.normal_scale);
          });
    group("KHR_materials_sheen", now.sheen, before.sheen,
          [&](json& e, const SheenModel& n, const SheenModel& b) {
            set_changed(e, "sheenColorFactor", n.color, b.color);
            set_changed(e, "sheenRoughnessFactor", n.roughness, b.roughness);
            textures_.set(e, "sheenColorTexture", n.color_texture, b.color_texture);
            textures_.set(e, "sheenRoughnessTexture", n.roughness_texture, b.roughness_texture);
          });
    group("KHR_materials_anisotropy", now.anisotropy, before.anisotropy,
          [&](json& e, const Anisotropy& n, const Anisotropy& b) {
            set_changed(e, "anisotropyStrength", n.strength, b.strength);
            set_changed(e, "anisotropyRotation", n.rotation, b.rotation);
            textures_.set(e, "anisotropyTexture", n.texture, b.texture);
          });
    group("KHR_materials_iridescence", now.iridescence, before.iridescence,
          [&](json& e, const Iridescence& n, const Iridescence& b) {
            set_changed(e, "iridescenceFactor", n.factor, b.factor);
            set_changed(e, "iridescenceIor", n.ior, b.ior);
            set_changed(e, "iridescenceThicknessMinimum", n.thickness_minimum, b.thickness_minimum);
            set_changed(e, "iridescenceThicknessMaximum", n.thickness_maximum, b.thickness_maximum);
            textures_.set(e, "iridescenceTexture", n.texture, b.texture);
            textures_.set(e, "iridescenceThicknessTexture", n.thickness_texture, b.thickness_texture);
          });
  }

  /// Those whose members need each other are written as a whole.
  void write_models(const Material& now, const Material& before) {
    if (now.phong != before.phong)
      group("PARIAN_materials_phong", now.phong, before.phong,
            [&](json& e, const PhongModel& n, const PhongModel&) {
              e["diffuse"] = to_json(n.diffuse);
              e["specular"] = to_json(n.specular);
              e["exponent"] = to_json(n.exponent);
            });
    if (now.conductor != before.conductor)
      group("PARIAN_materials_conductor", now.conductor, before.conductor,
            [&](json& e, const ConductorModel& n, const ConductorModel&) {
              e.erase("name");
              e["eta"] = to_json(n.eta);
              e["k"] = to_json(n.k);
            });
    if (now.subsurface != before.subsurface || (now.subsurface && now.ior != before.ior))
      group(
          "PARIAN_materials_subsurface", now.subsurface, before.subsurface,
          [&](json& e, const SubsurfaceModel& n, const SubsurfaceModel&) { set_subsurface(e, n, now.ior); });
  }

  /// Of coefficients per metre those per millimetre that the reader's product with 1000 makes the same
  /// floats of; where there are none for all, the same numbers at a scale of 1000.
  static void set_subsurface(json& e, const SubsurfaceModel& model, float eta) {
    for (const char* key : {"name", "color", "meanFreePath", "scale"}) e.erase(key);
    float scale = 1;
    const auto per_millimetre = [&](const Rgb& value) {
      Rgb found = value * 1e-3f;
      for (int k = 0; k < 3; ++k) {
        const float near = found[k];
        for (const float candidate : {near, std::nextafter(near, 0.0f), std::nextafter(near, 1e30f)})
          if (candidate * 1000.0f == value[k]) found[k] = candidate;
        if (found[k] * 1000.0f != value[k]) scale = 1000;
      }
      return found;
    };
    Rgb absorption = per_millimetre(model.absorption), scattering = per_millimetre(model.reduced_scattering);
    if (scale != 1) {
      absorption = model.absorption;
      scattering = model.reduced_scattering;
      e["scale"] = to_json(scale);
    }
    e["sigmaA"] = to_json(absorption);
    e["sigmaSPrime"] = to_json(scattering);
    e["eta"] = to_json(eta);
  }

  json& target_;
  const TextureUses& textures_;
};

}  // namespace

void write_material_extensions(json& target, const Material& now, const Material& before,
                               const TextureUses& textures) {
  ExtensionWriter(target, textures).write(now, before);
}

}  // namespace parian
