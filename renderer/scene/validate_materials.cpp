#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "renderer/scene/check.h"

namespace parian {
namespace {

constexpr float kMax = std::numeric_limits<float>::max();

/// The members of one group of a material, named as they are in it.
class GroupCheck {
 public:
  GroupCheck(const Scene& scene, std::string where, const Check& check)
      : scene_(scene), where_(std::move(where)), check_(check) {}

  GroupCheck group(const char* name) const { return {scene_, place(name), check_}; }

  void fail(const char* name, std::string_view expected) const { check_.fail(place(name), expected); }
  void factor(float value, const char* name) const { check_.range(value, 0, 1, place(name)); }
  void at_least(float low, float value, const char* name) const {
    check_.range(value, low, kMax, place(name));
  }
  void finite(float value, const char* name) const { check_.finite(value, place(name)); }
  void color(const Rgb& color, const char* name) const { check_.color(color, 1, place(name)); }
  void open_color(const Rgb& color, const char* name) const { check_.color(color, kMax, place(name)); }

  void texture(const TextureRef& ref, const char* name) const {
    check_.optional_index(ref.texture, scene_.textures.size(), place(name) + "/texture");
    if (ref.uv_set != 0 && ref.uv_set != 1) check_.fail(place(name) + "/uv_set", "expected 0 or 1");
    for (const float value : ref.transform) check_.finite(value, place(name) + "/transform");
  }

 private:
  std::string place(const char* name) const { return fmt::format("{}/{}", where_, name); }

  const Scene& scene_;
  std::string where_;
  const Check& check_;
};

void check_base(const Material& m, const GroupCheck& check) {
  check.color(m.base_color, "base_color");
  check.factor(m.alpha, "alpha");
  check.factor(m.metallic, "metallic");
  check.factor(m.roughness, "roughness");
  check.finite(m.normal_scale, "normal_scale");
  check.open_color(m.emission, "emission");
  if (m.ior != 0 && !(m.ior >= 1 && m.ior <= kMax))
    check.fail("ior", fmt::format("expected 0 or a number of at least 1, not {}", m.ior));
  check.factor(m.specular, "specular");
  check.open_color(m.specular_color, "specular_color");
  check.at_least(0, m.alpha_cutoff, "alpha_cutoff");
  check.texture(m.base_color_texture, "base_color_texture");
  check.texture(m.metallic_roughness_texture, "metallic_roughness_texture");
  check.texture(m.normal_texture, "normal_texture");
  check.texture(m.emission_texture, "emission_texture");
  check.texture(m.specular_texture, "specular_texture");
  check.texture(m.specular_color_texture, "specular_color_texture");
}

void check_group(const Transmission& t, const GroupCheck& check) {
  check.factor(t.factor, "factor");
  check.texture(t.texture, "texture");
}

void check_group(const Volume& v, const GroupCheck& check) {
  check.at_least(0, v.thickness, "thickness");
  check.color(v.attenuation_color, "attenuation_color");
  check.at_least(0, v.attenuation_distance, "attenuation_distance");
}

void check_group(const DiffuseTransmission& d, const GroupCheck& check) {
  check.factor(d.factor, "factor");
  check.color(d.color, "color");
  check.texture(d.texture, "texture");
  check.texture(d.color_texture, "color_texture");
}

void check_group(const Clearcoat& c, const GroupCheck& check) {
  check.factor(c.factor, "factor");
  check.factor(c.roughness, "roughness");
  check.texture(c.texture, "texture");
  check.texture(c.roughness_texture, "roughness_texture");
  check.texture(c.normal_texture, "normal_texture");
  check.finite(c.normal_scale, "normal_scale");
}

void check_group(const SheenModel& s, const GroupCheck& check) {
  check.color(s.color, "color");
  check.factor(s.roughness, "roughness");
  check.texture(s.color_texture, "color_texture");
  check.texture(s.roughness_texture, "roughness_texture");
}

void check_group(const Anisotropy& a, const GroupCheck& check) {
  check.factor(a.strength, "strength");
  check.finite(a.rotation, "rotation");
  check.texture(a.texture, "texture");
}

// The minimum may be above the maximum: a texture then goes the other way.
void check_group(const Iridescence& i, const GroupCheck& check) {
  check.factor(i.factor, "factor");
  check.at_least(1, i.ior, "ior");
  check.at_least(0, i.thickness_minimum, "thickness_minimum");
  check.at_least(0, i.thickness_maximum, "thickness_maximum");
  check.texture(i.texture, "texture");
  check.texture(i.thickness_texture, "thickness_texture");
}

void check_group(const PhongModel& p, const GroupCheck& check) {
  check.color(p.diffuse, "diffuse");
  check.color(p.specular, "specular");
  check.at_least(0, p.exponent, "exponent");
}

void check_group(const ConductorModel& c, const GroupCheck& check) {
  check.open_color(c.eta, "eta");
  check.open_color(c.k, "k");
}

void check_group(const VolumeScatter& v, const GroupCheck& check) {
  check.color(v.multiscatter_color, "multiscatter_color");
  if (!(std::abs(v.anisotropy) < 1)) check.fail("anisotropy", "expected a number between -1 and 1");
}

void check_group(const SubsurfaceModel& s, const GroupCheck& check) {
  check.open_color(s.absorption, "absorption");
  check.open_color(s.reduced_scattering, "reduced_scattering");
}

void check_material(const Material& m, const GroupCheck& check) {
  check_base(m, check);
  const auto group = [&](const auto& value, const char* name) {
    if (value) check_group(*value, check.group(name));
  };
  group(m.transmission, "transmission");
  group(m.volume, "volume");
  group(m.scatter, "scatter");
  group(m.diffuse_transmission, "diffuse_transmission");
  group(m.clearcoat, "clearcoat");
  group(m.sheen, "sheen");
  group(m.anisotropy, "anisotropy");
  group(m.iridescence, "iridescence");
  group(m.phong, "phong");
  group(m.conductor, "conductor");
  group(m.subsurface, "subsurface");
  if (m.phong && m.conductor) check.fail("phong", "expected none beside conductor");
  if (m.subsurface && (m.phong || m.conductor))
    check.fail("subsurface", "expected none beside phong or conductor");
  if (m.scatter && !m.volume) check.fail("scatter", "expected none without a volume");
  check.at_least(0, m.dispersion, "dispersion");
}

}  // namespace

void validate_materials(const Scene& scene, const Check& check) {
  check.each("materials", scene.materials, [&](const Material& material, const std::string& where) {
    check_material(material, {scene, where, check});
  });
}

}  // namespace parian
