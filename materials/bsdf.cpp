#include "materials/bsdf.h"

namespace parian {
namespace {

/// Fresnel reflectance at normal incidence against air; ior 0 stands for infinity (KHR_materials_ior).
float normal_reflectance(float ior) {
  if (ior == 0) return 1;
  const float r = (ior - 1) / (ior + 1);
  return r * r;
}

struct Dielectric {
  Rgb f0;
  float f90;
};

/// KHR_materials_specular: f0 = min(f0(ior) colour, 1) weight, f90 = weight.
Dielectric eval_dielectric(const Scene& scene, const Surface& s) {
  const Material& m = *s.part->material;
  float weight = m.specular;
  Rgb color = m.specular_color;
  if (m.specular_texture) weight *= eval_texture(scene, m.specular_texture, s.uvs, ColorSpace::linear).w;
  if (m.specular_color_texture) {
    const Vec4f t = eval_texture(scene, m.specular_color_texture, s.uvs, ColorSpace::srgb);
    color *= Rgb(t.x, t.y, t.z);
  }
  const Rgb f0 = color * normal_reflectance(m.ior);
  return {Rgb(std::min(f0.x, 1.0f), std::min(f0.y, 1.0f), std::min(f0.z, 1.0f)) * weight, weight};
}

}  // namespace

Rgb eval_base_color(const Scene& scene, const Surface& s) {
  const Material& m = *s.part->material;
  Rgb color = m.base_color;
  if (s.part->needs_color) color *= Rgb(s.color.x, s.color.y, s.color.z);
  if (m.base_color_texture) {
    const Vec4f t = eval_texture(scene, m.base_color_texture, s.uvs, ColorSpace::srgb);
    color *= Rgb(t.x, t.y, t.z);
  }
  return color;
}

Bsdf make_bsdf(const Scene& scene, const Surface& s) {
  const Material& m = *s.part->material;
  const Rgb base = eval_base_color(scene, s);
  if (m.specular == 0 && m.metallic == 0) return Bsdf(s, Lambert{base});

  float metallic = m.metallic, roughness = m.roughness;
  if (m.metallic_roughness_texture) {
    const Vec4f t = eval_texture(scene, m.metallic_roughness_texture, s.uvs, ColorSpace::linear);
    roughness *= t.y;
    metallic *= t.z;
  }
  const Dielectric dielectric = eval_dielectric(scene, s);
  return Bsdf(s, MetallicRoughness{base, metallic, dielectric.f0, dielectric.f90,
                                   Ggx{std::max(roughness * roughness, Ggx::kMinAlpha)}});
}

Rgb estimate_albedo(const Scene& scene, const Surface& s) {
  const Rgb base = eval_base_color(scene, s);
  if (s.part->material->unlit) return base;
  const Rgb f0 = eval_dielectric(scene, s).f0;
  return base * (1 - max_component(f0)) + f0;
}

}  // namespace parian
