#include "renderer/scene/surface.h"

namespace parian {
namespace {

template <class T>
T interpolate(const SharedArray<T>& values, const Triangle& t, float u, float v) {
  return values[t[0]] * (1 - u - v) + values[t[1]] * u + values[t[2]] * v;
}

[[gnu::cold, gnu::noinline]] Vec3f direction_of_extreme(const Vec3f& v, const Vec3f& otherwise) {
  const float largest = max_component(abs(v));
  return largest > 0 && largest < kInfinity ? normalize(v / largest) : otherwise;
}

/// Unit vector along v, whose square may leave the range of a float; `otherwise` where v has no direction.
inline Vec3f direction_of(const Vec3f& v, const Vec3f& otherwise) {
  const float length2 = v.dot(v);
  if (length2 > 1e-30f && length2 < 1e30f) return v * (1 / std::sqrt(length2));
  return direction_of_extreme(v, otherwise);
}

/// dp/du of the triangle in uv set `set`, world space; zero where the uvs are degenerate.
Vec3f uv_tangent(const Primitive& primitive, const Triangle& t, int set, const Vec3f& e1, const Vec3f& e2) {
  const SharedArray<Vec2f>& uvs = primitive.uvs[set];
  if (uvs.empty()) return Vec3f(0);
  const Vec2f d1 = uvs[t[1]] - uvs[t[0]], d2 = uvs[t[2]] - uvs[t[0]];
  const float det = d1.x * d2.y - d1.y * d2.x;
  // The sign is what matters: a mirrored map turns the tangent round.
  return det == 0 ? Vec3f(0) : (e1 * d2.y - e2 * d1.y) * (det < 0 ? -1.0f : 1.0f);
}

/// A tangent in world space, of any length, and the side on which the bitangent is: its sign against n x
/// tangent.
struct Tangent {
  Vec3f direction;
  float sign;
};

/// That of a triangle for its normal map; zero where there is none.
Tangent triangle_tangent(const Material& material, const Primitive& primitive, const Placement& placement,
                         const Hit& hit, const Vec3f& n, const Vec3f& e1, const Vec3f& e2) {
  const Triangle& t = primitive.triangles[hit.triangle];
  if (!primitive.tangents.empty()) {
    const Vec4f local = interpolate(primitive.tangents, t, hit.u, hit.v);
    return {placement.to_world.vector({local.x, local.y, local.z}),
            (local.w < 0) != (placement.to_world.determinant() < 0) ? -1.0f : 1.0f};
  }
  const int set = material.normal_texture.uv_set;
  const Vec3f tangent = uv_tangent(primitive, t, set, e1, e2);
  // v grows downwards in the image, so the bitangent is against dp/dv: its side follows from the map's
  // orientation.
  const SharedArray<Vec2f>& uvs = primitive.uvs[set];
  const Vec2f d1 = uvs.empty() ? Vec2f(0) : uvs[t[1]] - uvs[t[0]],
              d2 = uvs.empty() ? Vec2f(0) : uvs[t[2]] - uvs[t[0]];
  const Vec3f bitangent = (e1 * d2.x - e2 * d1.x) * (d1.x * d2.y - d1.y * d2.x < 0 ? -1.0f : 1.0f);
  return {tangent, n.cross(tangent).dot(bitangent) < 0 ? -1.0f : 1.0f};
}

/// Keeps the tangent, and applies the normal map where there is one.
Vec3f map_normal(const Scene& scene, Surface& s, const Vec3f& n, const Tangent& t) {
  const Material& material = *s.part->material;
  s.smooth_normal = n;
  s.tangent = t.direction;
  s.bitangent_sign = t.sign;
  if (!material.normal_texture) return n;
  // Where the normal is bent instead, what it mirrors must not lose its light.
  s.bumpy = !s.part->bends;
  return eval_normal_map(scene, s, material.normal_texture, material.normal_scale);
}

/// A shading normal so that the mirror direction of the viewer's is not below the surface: as near to ns as
/// that can be. wo.n > 0 and ns.n > 0, n the geometric normal on the viewer's side.
Vec3f bend_normal(const Vec3f& ns, const Vec3f& n, const Vec3f& wo) {
  constexpr float kLeast = 1e-3f;  // cosine of what is reflected, at least; less where the viewer's is less
  const Vec3f mirrored = ns * (2 * ns.dot(wo)) - wo;
  const float least = std::min(kLeast, 0.9f * wo.dot(n)), height = mirrored.dot(n);
  if (height >= least) return ns;
  return direction_of(direction_of(mirrored + n * (least - height), n) + wo, n);
}

/// The mean of the point's projections onto the planes across the normals of the vertices, by its barycentric
/// weights; where it is not below all of them the normals do not pretend a convex surface, and there is no
/// lift.
void set_lift(Surface& s, const Primitive& primitive, const Placement& placement, const Hit& hit) {
  const Triangle& t = primitive.triangles[hit.triangle];
  const Vec3f &a = primitive.positions[t[0]], &b = primitive.positions[t[1]], &c = primitive.positions[t[2]];
  const float w = 1 - hit.u - hit.v, side = s.front ? 1.0f : -1.0f;
  const Vec3f p = a * w + b * hit.u + c * hit.v;
  bool convex = true;
  const auto above = [&](const Vec3f& vertex, const Vec3f& normal, float weight) {
    const float height = (p - vertex).dot(normal);
    convex = convex && side * height <= 0;
    return normal * (-weight * height);
  };
  const Vec3f lift = above(a, primitive.normals[t[0]], w) + above(b, primitive.normals[t[1]], hit.u) +
                     above(c, primitive.normals[t[2]], hit.v);
  s.lift = placement.identity ? lift : placement.to_world.vector(lift);
  s.lifted = convex && s.lift.dot(s.ng) * side > 4 * s.offset;
}

/// Turns a shading normal towards the viewer, and makes the frame around it. (Inlined at both of its calls,
/// or meshes would pay for there being solids.)
[[gnu::always_inline]] inline void set_frame(Surface& s, Vec3f ns) {
  if (!s.front) ns = -ns;
  // A shading normal that faces away from the viewer cannot be shaded: the geometric one takes its place.
  if (s.wo.dot(ns) <= 0) ns = s.front ? s.ng : -s.ng;
  if (s.part->bends) ns = bend_normal(ns, s.front ? s.ng : -s.ng, s.wo);
  s.frame = make_frame(ns);
}

}  // namespace

Surface make_mesh_surface(const Scene& scene, const World& world, const Hit& hit, const Vec3f& d) {
  const Placement& placement = world.placements[hit.placement];
  const Part& part = world.parts[placement.first_part + hit.primitive];
  const Primitive& primitive = *part.primitive;
  const Triangle& t = primitive.triangles[hit.triangle];
  const Vec3f &v0 = primitive.positions[t[0]], &v1 = primitive.positions[t[1]],
              &v2 = primitive.positions[t[2]];

  Surface s;
  s.part = &part;
  s.wo = -d;
  Vec3f e1 = v1 - v0, e2 = v2 - v0;
  Vec3f normal = e1.cross(e2);
  float extent = max_component(max(abs(v0), max(abs(v1), abs(v2))));
  s.p = v0 * (1 - hit.u - hit.v) + v1 * hit.u + v2 * hit.v;
  if (!placement.identity) {
    const Affine& m = placement.to_world;
    s.p = m.point(s.p);
    e1 = m.vector(e1);
    e2 = m.vector(e2);
    normal = m.normal(normal);
    extent = placement.extent(extent);
  }
  s.ng = direction_of(normal, s.wo);
  s.offset = plane_offset(extent);
  s.front = s.wo.dot(s.ng) >= 0;
  if (part.needs_uv) s.uvs = interpolate_uvs(primitive, t, hit.u, hit.v);
  s.color = part.needs_color ? interpolate(primitive.colors, t, hit.u, hit.v) : Vec4f(1);
  s.lifted = false;
  s.bumpy = false;

  Vec3f ns = s.ng;
  if (!primitive.normals.empty()) {
    const Vec3f local = interpolate(primitive.normals, t, hit.u, hit.v);
    ns = direction_of(placement.identity ? local : placement.to_world.normal(local), s.ng);
    if (!part.bends && part.medium == kNone) set_lift(s, primitive, placement, hit);
  }
  if (part.needs_tangent)
    ns = map_normal(scene, s, ns, triangle_tangent(*part.material, primitive, placement, hit, ns, e1, e2));
  set_frame(s, ns);
  return s;
}

Surface make_solid_surface(const Scene& scene, const World& world, const Hit& hit, const Vec3f& d) {
  const PlacedSolid& placed = world.solids[hit.solid()];
  const Vec3f local(hit.u, hit.v, hit.w);
  const SolidPoint point = surface_point(placed.solid, local, Face(hit.triangle));
  Surface s;
  s.part = &world.solid_parts[placed.part];
  s.wo = -d;
  const Affine& m = placed.to_world;
  s.p = Vec3f(Affined{Vec3d(m.x), Vec3d(m.y), Vec3d(m.z), Vec3d(m.origin)}.point(Vec3d(local)));
  s.ng = direction_of(m.normal(point.normal), s.wo);
  s.offset = solid_offset(m, local);
  s.front = s.wo.dot(s.ng) >= 0;
  s.uvs = {point.uv, point.uv};
  s.color = Vec4f(1);
  s.lifted = false;
  s.bumpy = false;
  Vec3f ns = s.ng;
  if (s.part->needs_tangent) {
    const float sign = m.determinant() < 0 ? -1.0f : 1.0f;
    ns = map_normal(scene, s, ns, {m.vector(point.dpdu), sign});
  }
  set_frame(s, ns);
  return s;
}

int hit_node(const World& world, const Hit& hit) {
  if (hit.placement == Hit::kAreaLightHit) return world.area_lights[hit.triangle].node;
  return hit.is_solid() ? world.solids[hit.solid()].node : world.placements[hit.placement].node;
}

Vec3f eval_normal_map(const Scene& scene, const Surface& s, const TextureRef& map, float scale) {
  const Vec3f& n = s.smooth_normal;
  Vec3f tangent = s.tangent - n * n.dot(s.tangent);
  const float length = tangent.length();
  if (!(length > 0)) return n;
  tangent /= length;
  const Vec3f bitangent = n.cross(tangent) * s.bitangent_sign;
  const Vec4f texel = eval_texture(scene, map, s.uvs, ColorSpace::linear);
  const Vec3f m((2 * texel.x - 1) * scale, (2 * texel.y - 1) * scale, 2 * texel.z - 1);
  const Vec3f mapped = tangent * m.x + bitangent * m.y + n * m.z;
  return mapped.dot(mapped) > 0 ? mapped.normalized() : n;
}

float bump_shadowing(const Surface& s, const Vec3f& w) {
  const bool below = w.dot(s.frame.z) < 0;
  const float cosine = w.dot(s.smooth_normal) * (s.front == below ? -1.0f : 1.0f);
  if (cosine <= 0) return 0;
  const float deviation = s.frame.z.dot(s.smooth_normal), cos2 = deviation * deviation;
  const float alpha2 = std::clamp((1 - cos2) / (8 * cos2), 0.0f, 1.0f);
  return 2 * cosine / (cosine + std::sqrt(cosine * cosine + alpha2 * (1 - cosine * cosine)));
}

Vec3f hit_normal(const World& world, const Hit& hit) {
  if (hit.is_solid()) {
    const PlacedSolid& placed = world.solids[hit.solid()];
    const SolidPoint point = surface_point(placed.solid, {hit.u, hit.v, hit.w}, Face(hit.triangle));
    return placed.to_world.normal(point.normal);
  }
  const Part& part = hit_part(world, hit);
  const Primitive& primitive = *part.primitive;
  const Triangle& t = primitive.triangles[hit.triangle];
  const Vec3f& v0 = primitive.positions[t[0]];
  const Vec3f n = world.placements[hit.placement].to_world.normal(
      (primitive.positions[t[1]] - v0).cross(primitive.positions[t[2]] - v0));
  return part.inside_out ? -n : n;
}

float solid_offset(const Affine& to_world, const Vec3f& point) {
  const Vec3f sums = abs(to_world.x) * std::abs(point.x) + abs(to_world.y) * std::abs(point.y) +
                     abs(to_world.z) * std::abs(point.z) + abs(to_world.origin);
  return error_gamma(12) * max_component(sums);
}

Rgb eval_emission(const Scene& scene, const Material& material, const std::array<Vec2f, 2>& uvs,
                  float cosine) {
  Rgb emission = material.emission;
  if (material.emission_texture) {
    const Vec4f texel = eval_texture(scene, material.emission_texture, uvs, ColorSpace::srgb);
    emission *= Rgb(texel.x, texel.y, texel.z);
  }
  if (material.clearcoat) {
    float coat = material.clearcoat->factor;
    if (const TextureRef& texture = material.clearcoat->texture)
      coat *= eval_texture(scene, texture, uvs, ColorSpace::linear).x;
    emission *= 1 - coat * (0.04f + 0.96f * std::pow(1 - std::min(1.0f, cosine), 5.0f));
  }
  return emission;
}

std::array<Vec2f, 2> interpolate_uvs(const Primitive& primitive, const Triangle& triangle, float u, float v) {
  std::array<Vec2f, 2> uvs{Vec2f(0), Vec2f(0)};
  for (int set = 0; set < 2; ++set)
    if (!primitive.uvs[set].empty()) uvs[set] = interpolate(primitive.uvs[set], triangle, u, v);
  return uvs;
}

float eval_coverage(const Scene& scene, const Material& material, const std::array<Vec2f, 2>& uvs,
                    float alpha) {
  alpha *= material.alpha;
  if (material.base_color_texture)
    alpha *= eval_texture(scene, material.base_color_texture, uvs, ColorSpace::srgb).w;
  if (material.alpha_mode == AlphaMode::mask) return alpha >= material.alpha_cutoff ? 1 : 0;
  return alpha;
}

float eval_coverage(const Scene& scene, const Part& part, std::uint32_t triangle, float u, float v) {
  const Primitive& primitive = *part.primitive;
  const Triangle& t = primitive.triangles[triangle];
  const float alpha = primitive.colors.empty() ? 1 : interpolate(primitive.colors, t, u, v).w;
  std::array<Vec2f, 2> uvs{Vec2f(0), Vec2f(0)};
  if (part.material->base_color_texture) uvs = interpolate_uvs(primitive, t, u, v);
  return eval_coverage(scene, *part.material, uvs, alpha);
}

}  // namespace parian
