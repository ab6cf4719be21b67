#include "materials/bsdf.h"

namespace parian {
namespace {

/// eval_base_color(), in place where every path comes by.
[[gnu::always_inline]] inline Rgb base_color_at(const Scene& scene, const Surface& s) {
  const Material& m = *s.part->material;
  Rgb color = m.base_color;
  if (s.part->needs_color) color *= Rgb(s.color.x, s.color.y, s.color.z);
  if (m.base_color_texture) {
    const Vec4f t = eval_texture(scene, m.base_color_texture, s.uvs, ColorSpace::srgb);
    color *= Rgb(t.x, t.y, t.z);
  }
  return color;
}

/// Fresnel reflectance at normal incidence against air; ior 0 stands for infinity (KHR_materials_ior).
float normal_reflectance(float ior) {
  if (ior == 0) return 1;
  const float r = (ior - 1) / (ior + 1);
  return r * r;
}

struct Coat {
  Rgb f0;
  float f90;
};

Rgb min(const Rgb& c, float most) { return {std::min(c.x, most), std::min(c.y, most), std::min(c.z, most)}; }

/// KHR_materials_specular with its textures.
struct SpecularWeight {
  float factor;
  Rgb color;
};

SpecularWeight eval_specular(const Scene& scene, const Surface& s) {
  const Material& m = *s.part->material;
  float factor = m.specular;
  Rgb color = m.specular_color;
  if (m.specular_texture) factor *= eval_texture(scene, m.specular_texture, s.uvs, ColorSpace::linear).w;
  if (m.specular_color_texture) {
    const Vec4f t = eval_texture(scene, m.specular_color_texture, s.uvs, ColorSpace::srgb);
    color *= Rgb(t.x, t.y, t.z);
  }
  return {factor, color};
}

/// KHR_materials_specular: f0 = min(f0(ior) colour, 1) weight, f90 = weight.
Coat eval_coat(const Scene& scene, const Surface& s) {
  const SpecularWeight weight = eval_specular(scene, s);
  return {min(weight.color * normal_reflectance(s.part->material->ior), 1) * weight.factor, weight.factor};
}

float eval_roughness(const Scene& scene, const Surface& s) {
  const Material& m = *s.part->material;
  if (!m.metallic_roughness_texture) return m.roughness;
  return m.roughness * eval_texture(scene, m.metallic_roughness_texture, s.uvs, ColorSpace::linear).y;
}

float to_alpha(float roughness) { return std::max(roughness * roughness, Ggx::kMinAlpha); }
/// 0 where a mirror is meant.
float to_mirror_alpha(float roughness) {
  const float alpha = roughness * roughness;
  return alpha < Ggx::kMinAlpha ? 0 : alpha;
}

/// The channel of a texture times a factor; the factor alone where there is none.
float scaled(const Scene& scene, const Surface& s, const TextureRef& texture, int channel, float factor) {
  return texture ? factor * eval_texture(scene, texture, s.uvs, ColorSpace::linear)[channel] : factor;
}
Rgb scaled(const Scene& scene, const Surface& s, const TextureRef& texture, const Rgb& factor) {
  if (!texture) return factor;
  const Vec4f t = eval_texture(scene, texture, s.uvs, ColorSpace::srgb);
  return factor * Rgb(t.x, t.y, t.z);
}

/// The interface of a surface that transmits. Inside a medium its reflectance at normal incidence is by the
/// relative index.
Dielectric make_dielectric(const Scene& scene, const Surface& s, const Rgb& base, float alpha, float eta) {
  constexpr float kInfiniteIor = 1e6f;
  const Material& m = *s.part->material;
  const bool thin = s.part->medium == kNone;
  const float index = !thin ? eta : m.ior == 0 ? kInfiniteIor : m.ior, r = (index - 1) / (index + 1);
  const SpecularWeight weight = eval_specular(scene, s);
  return {index, base, {alpha}, thin, min(weight.color * (r * r), 1) * weight.factor, weight.factor};
}

/// Whether any part of the material needs more than metal, coat and diffuse base.
bool is_layered(const Material& m) {
  return (m.clearcoat && m.clearcoat->factor > 0) || (m.sheen && !is_black(m.sheen->color)) ||
         (m.anisotropy && m.anisotropy->strength > 0) || (m.iridescence && m.iridescence->factor > 0) ||
         (m.diffuse_transmission && m.diffuse_transmission->factor > 0);
}

/// The unit vector, on the viewer's side, in the shading frame.
Vec3f to_local_normal(const Surface& s, const Vec3f& n) { return s.frame.to_local(s.front ? n : -n); }

/// KHR_materials_anisotropy: the roughness along the direction grows with the square of the strength.
void set_anisotropy(const Scene& scene, const Surface& s, float alpha, Layered& lobe) {
  const Anisotropy& a = *s.part->material->anisotropy;
  float strength = a.strength;
  Vec2f direction(std::cos(a.rotation), std::sin(a.rotation));
  if (a.texture) {
    const Vec4f t = eval_texture(scene, a.texture, s.uvs, ColorSpace::linear);
    const Vec2f d(2 * t.x - 1, 2 * t.y - 1);
    direction = {direction.x * d.x - direction.y * d.y, direction.y * d.x + direction.x * d.y};
    strength *= t.z;
  }
  // From the tangent and its bitangent to the shading frame.
  const Vec3f bitangent = s.smooth_normal.cross(s.tangent) * s.bitangent_sign;
  const Vec3f along = s.frame.to_local(s.tangent * direction.x + bitangent * direction.y);
  const float length = std::sqrt(along.x * along.x + along.y * along.y);
  if (!(length > 0)) return;
  lobe.tangent = {along.x / length, along.y / length};
  lobe.facets.alpha_x = alpha + (1 - alpha) * strength * strength;
}

void set_coat(const Scene& scene, const Surface& s, Layered& lobe) {
  const Material& m = *s.part->material;
  const Clearcoat& c = *m.clearcoat;
  lobe.coat = scaled(scene, s, c.texture, 0, c.factor);
  lobe.coat_ggx = {to_alpha(scaled(scene, s, c.roughness_texture, 1, c.roughness))};
  // Without a map of its own the coat is smooth over a base that has one.
  if (c.normal_texture)
    lobe.coat_normal = to_local_normal(s, eval_normal_map(scene, s, c.normal_texture, c.normal_scale));
  else if (m.normal_texture)
    lobe.coat_normal = to_local_normal(s, s.smooth_normal);
}

Layered make_layered(const Scene& scene, const Surface& s, const Rgb& base, float metallic, float roughness,
                     float transmission, float eta) {
  const Material& m = *s.part->material;
  const float alpha = to_alpha(roughness);
  // An index that is matched would leave facets nothing to refract by.
  const float index = std::abs(eta - 1) < 1e-3f ? 1.001f : eta;
  Layered lobe{
      metallic,      base, {base, Rgb(0, 0, 0)}, transmission, make_dielectric(scene, s, base, alpha, index),
      {alpha, alpha}};
  if (transmission == 0) {
    const Coat coat = eval_coat(scene, s);
    lobe.dielectric.f0 = coat.f0;
    lobe.dielectric.f90 = coat.f90;
  }
  if (const auto& d = m.diffuse_transmission) {
    const float factor = scaled(scene, s, d->texture, 3, d->factor);
    lobe.diffuse = {base * (1 - factor), scaled(scene, s, d->color_texture, d->color) * factor};
  }
  if (m.anisotropy && m.anisotropy->strength > 0) set_anisotropy(scene, s, alpha, lobe);
  if (const auto& i = m.iridescence) {
    lobe.iridescence = scaled(scene, s, i->texture, 0, i->factor);
    lobe.film_ior = i->ior;
    const float t = i->thickness_texture ? scaled(scene, s, i->thickness_texture, 1, 1) : 1;
    lobe.film_thickness = i->thickness_minimum + (i->thickness_maximum - i->thickness_minimum) * t;
  }
  if (const auto& sheen = m.sheen) {
    const float r = scaled(scene, s, sheen->roughness_texture, 3, sheen->roughness);
    lobe.sheen = {scaled(scene, s, sheen->color_texture, sheen->color), std::max(r * r, Sheen::kMinAlpha)};
  }
  if (m.clearcoat && m.clearcoat->factor > 0) set_coat(scene, s, lobe);
  return lobe;
}

/// The lobe of a material that has an extension: the smallest that holds what it has. (Cold: in its place in
/// make_bsdf() it would be felt by those that have none.)
[[gnu::cold, gnu::noinline]] Bsdf::AnyLobe make_extended(const Scene& scene, const Surface& s,
                                                         const Rgb& base, Microfacets microfacets,
                                                         float eta) {
  const auto finished = [&](const auto& lobe) -> Bsdf::AnyLobe {
    if (microfacets == Microfacets::single) return lobe;
    return make_compensated(lobe);
  };
  const Material& m = *s.part->material;
  if (m.phong) return Phong{m.phong->diffuse, m.phong->specular, m.phong->exponent};
  const float roughness = eval_roughness(scene, s);
  if (m.conductor) return finished(Conductor{m.conductor->eta, m.conductor->k, {to_mirror_alpha(roughness)}});
  // All that a body which scatters inside does not reflect goes in.
  const float metallic = m.subsurface ? 0 : scaled(scene, s, m.metallic_roughness_texture, 2, m.metallic);
  const float transmission = m.subsurface ? 1
                             : m.transmission
                                 ? scaled(scene, s, m.transmission->texture, 0, m.transmission->factor)
                                 : 0;
  if (!is_layered(m) && transmission == 1 && metallic == 0)
    return finished(make_dielectric(scene, s, base, to_mirror_alpha(roughness), eta));
  if (!is_layered(m) && transmission == 0) {
    const Coat coat = eval_coat(scene, s);
    return finished(MetallicRoughness{base, metallic, coat.f0, coat.f90, Ggx{to_alpha(roughness)}});
  }
  return finished(make_layered(scene, s, base, metallic, roughness, transmission, eta));
}

}  // namespace

Rgb eval_base_color(const Scene& scene, const Surface& s) { return base_color_at(scene, s); }

BsdfValue Bsdf::eval_lobe(const Vec3f& wi) const {
  const float lit = surface_.bumpy ? bump_shadowing(surface_, wi) : 1;
  if (lit == 0) return {};
  BsdfValue value =
      std::visit([&](const auto& lobe) { return lobe.eval(to_local(surface_.wo), to_local(wi)); }, lobe_);
  value.f_cos *= lit;
  return value;
}

bool Bsdf::shadow(BsdfSample& s) const {
  const float lit = bump_shadowing(surface_, s.wi);
  s.weight *= lit;
  return lit > 0;
}

std::optional<BsdfSample> Bsdf::sample_lobe(float u1, const Vec2f& u2) const {
  return std::visit([&](const auto& lobe) { return lobe.sample(to_local(surface_.wo), u1, u2); }, lobe_);
}

Bsdf make_bsdf(const Scene& scene, const Surface& s, Microfacets microfacets, float eta) {
  const Material& m = *s.part->material;
  const Rgb base = base_color_at(scene, s);
  if (m.specular == 0 && m.metallic == 0 && !s.part->extended) return Bsdf(s, Lambert{base});
  if (s.part->extended) [[unlikely]]
    return Bsdf(s, make_extended(scene, s, base, microfacets, eta));

  float metallic = m.metallic, roughness = m.roughness;
  if (m.metallic_roughness_texture) {
    const Vec4f t = eval_texture(scene, m.metallic_roughness_texture, s.uvs, ColorSpace::linear);
    roughness *= t.y;
    metallic *= t.z;
  }
  const Coat coat = eval_coat(scene, s);
  const MetallicRoughness lobe{base, metallic, coat.f0, coat.f90, Ggx{to_alpha(roughness)}};
  return Bsdf(s, microfacets == Microfacets::single ? lobe : make_compensated(lobe));
}

Rgb eval_crossing_tint(const Scene& scene, const Surface& s) {
  const auto& diffuse = s.part->material->diffuse_transmission;
  return diffuse ? scaled(scene, s, diffuse->color_texture, diffuse->color) : base_color_at(scene, s);
}

Rgb estimate_albedo(const Scene& scene, const Surface& s) {
  const Material& m = *s.part->material;
  const Rgb base = eval_base_color(scene, s);
  if (m.unlit) return base;
  if (m.phong) return m.phong->diffuse + m.phong->specular;
  if (m.conductor) return fresnel_conductor(1, m.conductor->eta, m.conductor->k);
  const Rgb f0 = eval_coat(scene, s).f0;
  return base * (1 - max_component(f0)) + f0;
}

}  // namespace parian
