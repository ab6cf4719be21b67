#include "materials/layered.h"

#include <numeric>

#include "materials/albedo.h"
#include "materials/iridescence.h"

namespace parian {
namespace {

const Rgb kWhite(1, 1, 1);

bool has_sheen(const Sheen& sheen) { return !is_black(sheen.color); }

}  // namespace

Layered::Reflectance Layered::reflectance(float cosine) const {
  // Schlick's, as glTF has it, but where light gets through: from inside it is total beyond some angle.
  Reflectance r;
  if (transmission > 0) {
    r.dielectric = dielectric.reflectance(cosine);
  } else {
    const Rgb f90 = kWhite * dielectric.f90;
    r.dielectric = dielectric.f0 + (f90 - dielectric.f0) * schlick_weight(cosine);
  }
  r.metal = metal_f0 + (kWhite - metal_f0) * schlick_weight(cosine);
  if (iridescence > 0) {
    const auto mix = [&](const Rgb& plain, const Rgb& f0) {
      if (plain.x == 1 && plain.y == 1 && plain.z == 1) return plain;  // total, film or none
      return plain * (1 - iridescence) +
             iridescent_reflectance(cosine, film_ior, film_thickness, f0) * iridescence;
    };
    r.dielectric = mix(r.dielectric, dielectric.f0);
    r.metal = mix(r.metal, metal_f0);
  }
  return r;
}

std::array<float, Layered::kParts> Layered::shares(const Vec3f& wo) const {
  const Reflectance r = reflectance(wo.z);
  // Where a mirror reflects all, facets still let some through.
  const float below = (1 - metallic) * std::max(0.01f, 1 - max_component(r.dielectric));
  std::array<float, kParts> share{};
  share[kCoat] = coat_reflectance(wo);
  share[kSheen] = has_sheen(sheen) ? luminance(sheen.color) * sheen_albedo(wo.z, sheen.alpha) : 0;
  share[kFacets] = luminance(r.dielectric) * (1 - metallic) + luminance(r.metal) * metallic;
  if (compensation) {
    const FacetBounces& bounces = compensation->bounces;
    share[kBounces] = bounces.albedo * bounces.row.at(wo.z).loss;
  }
  share[kDiffuse] =
      below * (1 - transmission) * (luminance(diffuse.reflected) + luminance(diffuse.transmitted));
  share[kTransmission] = below * transmission * luminance(dielectric.tint);
  float sum = std::accumulate(share.begin(), share.end(), 0.0f);
  if (!(sum > 0)) return share;
  // Facets that reflect little from here may still shine at grazing angles; what bounces between them is
  // nearly cosine-distributed and needs no more than its share.
  for (int part = 0; part < kParts; ++part)
    if (float& s = share[std::size_t(part)]; s > 0) s = std::max(s / sum, part == kBounces ? 1e-3f : 0.05f);
  sum = std::accumulate(share.begin(), share.end(), 0.0f);
  for (float& s : share) s /= sum;
  return share;
}

BsdfValue Layered::eval(const Vec3f& wo, const Vec3f& wi) const { return eval(wo, wi, shares(wo)); }

BsdfValue Layered::eval(const Vec3f& wo, const Vec3f& wi, const std::array<float, kParts>& share) const {
  if (wi.z == 0) return {};
  const float below = (1 - coat_reflectance(wo)) * (has_sheen(sheen) ? sheen.base_scale(wo, wi) : 1);
  BsdfValue value;
  const auto add = [&](Part part, const Rgb& f_cos, float pdf) {
    value.f_cos += f_cos;
    value.pdf += share[part] * pdf;
  };
  const BsdfValue base = diffuse.eval(wo, wi);
  GgxAlbedo o{}, i{};
  if (compensation) {
    o = compensation->bounces.row.at(wo.z);
    i = compensation->bounces.row.at(std::abs(wi.z));
  }
  // What the interface of the dielectric lets through to the diffuse base, of a facet that reflects r.
  const auto add_diffuse = [&](const Rgb& r) {
    const float through = compensation ? compensation->under_coat(o, i) : 1 - max_component(r);
    add(kDiffuse, base.f_cos * (below * (1 - metallic) * (1 - transmission) * through), base.pdf);
  };
  if (wi.z < 0) {
    add_diffuse(reflectance(wo.z).dielectric);
    if (transmission > 0) {
      const Dielectric::Transmitted t = dielectric.eval_transmitted(wo, wi);
      float through = below * (1 - metallic) * transmission;
      // What a film reflects more than the bare interface does not get through, and the other way round.
      if (iridescence > 0 && !is_black(t.f_cos))
        through *= (1 - max_component(reflectance(t.cosine).dielectric)) /
                   (1 - max_component(dielectric.reflectance(t.cosine)));
      add(kTransmission, t.f_cos * through, t.pdf);
    }
    return value;
  }

  const Vec3f h = normalize(wo + wi);
  const Reflectance r = reflectance(wo.dot(h));
  const Vec3f fo = to_facets(wo), fi = to_facets(wi), fh = to_facets(h);
  const float facet = facets.d(fh) / (4 * wo.z);
  const Rgb reflected = r.dielectric * ((1 - metallic) * dielectric.scale(wo)) + r.metal * metallic;
  add(kFacets, reflected * (facets.g2(fo, fi) * facet * below), facets.g1(fo) * facet);
  if (compensation) add(kBounces, compensation->bounces.eval(o.loss, i.loss) * (wi.z * below), kInvPi * wi.z);
  add_diffuse(r.dielectric);
  if (has_sheen(sheen)) {
    const BsdfValue s = sheen.eval(wo, wi);
    add(kSheen, s.f_cos * (1 - coat_reflectance(wo)), s.pdf);
  }
  if (coat > 0) {
    const Frame frame = make_frame(coat_normal);
    const Vec3f co = frame.to_local(wo), ci = frame.to_local(wi);
    if (co.z > 0 && ci.z > 0) {
      const Vec3f ch = normalize(co + ci);
      const float d = coat_ggx.d(ch) / (4 * co.z);
      add(kCoat, kWhite * (coat_reflectance(wo) * coat_ggx.g2(co, ci) * d), coat_ggx.g1(co) * d);
    }
  }
  return value;
}

std::optional<Vec3f> Layered::sample_part(Part part, const Vec3f& wo, float u1, const Vec2f& u2) const {
  switch (part) {
    case kCoat: {
      const Frame frame = make_frame(coat_normal);
      const Vec3f co = frame.to_local(wo);
      if (co.z <= 0) return std::nullopt;
      const Vec3f h = coat_ggx.sample_visible_normal(co, u2);
      const Vec3f ci = h * (2 * co.dot(h)) - co;
      if (ci.z <= 0) return std::nullopt;
      return frame.to_world(ci);
    }
    case kFacets: {
      const Vec3f fo = to_facets(wo), h = facets.sample_visible_normal(fo, u2);
      const Vec3f fi = h * (2 * fo.dot(h)) - fo;
      return Vec3f(tangent.x * fi.x - tangent.y * fi.y, tangent.y * fi.x + tangent.x * fi.y, fi.z);
    }
    case kBounces:
      return sample_cosine_hemisphere(u2);
    case kTransmission:
      return dielectric.sample_transmitted(wo, u2);
    default: {
      const auto s = part == kSheen ? sheen.sample(wo, u1, u2) : diffuse.sample(wo, u1, u2);
      if (!s) return std::nullopt;
      return s->wi;
    }
  }
}

std::optional<BsdfSample> Layered::sample(const Vec3f& wo, float u1, const Vec2f& u2) const {
  const std::array<float, kParts> share = shares(wo);
  int part = 0;
  while (part < kParts - 1 && u1 >= share[std::size_t(part)]) u1 -= share[std::size_t(part++)];
  if (!(share[std::size_t(part)] > 0)) return std::nullopt;
  u1 = std::min(u1 / share[std::size_t(part)], 0x1.fffffep-1f);
  const std::optional<Vec3f> wi = sample_part(Part(part), wo, u1, u2);
  if (!wi) return std::nullopt;
  // Reflections below the surface, transmissions above it.
  if (part == kDiffuse ? wi->z == 0 : (wi->z > 0) == (part == kTransmission)) return std::nullopt;
  const BsdfValue value = eval(wo, *wi, share);
  if (!(value.pdf > 0 && value.pdf < kInfinity)) return std::nullopt;
  return BsdfSample{*wi, value.f_cos * (1 / value.pdf), value.pdf};
}

Layered make_compensated(Layered lobe) {
  // Of a thin film what it reflects at normal incidence.
  const Layered::Reflectance normal = lobe.reflectance(1);
  const float x = lobe.facets.alpha_x, y = lobe.facets.alpha_y, alpha = std::sqrt((x * x + y * y) / 2);
  lobe.compensation =
      make_compensation(normal.metal, lobe.metallic, normal.dielectric, lobe.dielectric.f90, alpha);
  if (lobe.transmission == 0) return lobe;
  // An interface that light gets through makes up for its losses on both sides; what bounces is metal alone.
  lobe.dielectric = make_compensated(lobe.dielectric);
  FacetBounces& bounces = lobe.compensation->bounces;
  Rgb metal;
  for (int k = 0; k < 3; ++k)
    metal[k] = lobe.metallic * bounced_reflectance(normal.metal[k] + (1 - normal.metal[k]) * (1 / 21.0f),
                                                   bounces.row.average_loss);
  bounces = make_facet_bounces(bounces.row, metal);
  return lobe;
}

}  // namespace parian
