/// From a hit to what shading needs: position with its error bound, normals, shading frame, texture
/// coordinates.
#pragma once

#include <cstdint>

#include "renderer/scene/texture.h"
#include "renderer/scene/world.h"

namespace parian {

/// What a ray hit: triangle `triangle` of primitive `primitive` of placement `placement` at barycentric
/// weights (1 - u - v, u, v); or, where is_solid(), face `triangle` of solid `placement` - kSolid at the
/// point (u, v, w) of its own space; or, where placement is kAreaLightHit, area light `triangle`; or, where
/// it is kMiss, nothing.
struct Hit {
  static constexpr std::uint32_t kAreaLightHit = 0xffffffffu, kMiss = 0xfffffffeu, kSolid = 0x80000000u;
  float t, u, v;
  std::uint32_t placement, primitive, triangle;
  float w = 0;  // of a solid alone

  bool is_solid() const { return placement >= kSolid && placement < kMiss; }
  std::uint32_t solid() const { return placement - kSolid; }
};

struct Surface {
  Vec3f p;       // world space
  float offset;  // distance along ng that clears every rounding error in p and in an intersection near it
  Vec3f ng;      // unit geometric normal, on the front side
  Vec3f wo;      // unit, towards where the ray came from
  bool front;    // wo is on the side of ng
  Frame frame;   // shading frame; frame.z is on the side of wo
  // Where normals are interpolated and pretend a curved surface above the triangle, by more than rounding:
  // from p to that, on the side of wo. Else not lifted, and not set.
  bool lifted;
  // A normal map pretends bumps here, which take light from each other: bump_shadowing().
  bool bumpy;
  Vec3f lift;
  // Only where part->needs_tangent: the shading normal without its map, on the front side; the tangent, of
  // any length and zero where there is none, and the side of the bitangent, its sign against smooth_normal x
  // tangent.
  Vec3f smooth_normal, tangent;
  float bitangent_sign;
  const Part* part;
  std::array<Vec2f, 2> uvs;  // only where part->needs_uv
  Vec4f color;               // vertex colour, white where there is none
};

/// The surface at a hit on a mesh by a ray of unit direction d, and that at a hit on a solid.
Surface make_mesh_surface(const Scene& scene, const World& world, const Hit& hit, const Vec3f& d);
Surface make_solid_surface(const Scene& scene, const World& world, const Hit& hit, const Vec3f& d);
/// Whichever it is.
inline Surface make_surface(const Scene& scene, const World& world, const Hit& hit, const Vec3f& d) {
  return hit.is_solid() ? make_solid_surface(scene, world, hit, d) : make_mesh_surface(scene, world, hit, d);
}

/// The normal that a normal map gives (glTF 2.0, 3.9.3), unit, on the front side; smooth_normal where there
/// is no tangent. The part needs a tangent.
Vec3f eval_normal_map(const Scene& scene, const Surface& s, const TextureRef& map, float scale);

/// The share of the light along w, unit and away from the surface, that bumps leave to the one whose normal
/// is the shading normal. The surface is bumpy. With theta the angle of w, and d that of the shading normal,
/// from smooth_normal it is Smith's shadowing of GGX slopes,
///   2 / (1 + sqrt(1 + alpha^2 tan^2 theta)), alpha^2 = min(1, tan^2 d / 8)
/// (Estevez, Lecocq and Stein 2019, A Microfacet-Based Shadowing Function to Solve the Bump Terminator
/// Problem, Ray Tracing Gems, chapter 12). 0 where smooth_normal puts w on another side than the shading
/// normal does.
float bump_shadowing(const Surface& s, const Vec3f& w);

/// The node that shows what was hit, which is not nothing.
int hit_node(const World& world, const Hit& hit);

/// The part that was hit, which is neither nothing nor an area light.
inline const Part& hit_part(const World& world, const Hit& hit) {
  return hit.is_solid() ? world.solid_parts[world.solids[hit.solid()].part]
                        : world.part(hit.placement, hit.primitive);
}

/// Gives a surface of a part that is inside out the front that it should have.
inline void turn(Surface& s) {
  s.ng = -s.ng;
  s.front = !s.front;
}

/// The normal of what was hit, not of unit length: of its triangle or solid, on its front side (of what is
/// inside out, on the other), world space.
Vec3f hit_normal(const World& world, const Hit& hit);

/// Where a ray along w leaves: p moved to w's side of the surface, beyond the rounding error. From a surface
/// that is lifted what the shading normal reflects leaves from there: from the triangle itself the light that
/// the curved surface would still see is below the horizon, so that the terminator follows the triangles
/// (Hanika 2021, Hacking the Shadow Terminator, Ray Tracing Gems II, chapter 4).
inline Vec3f ray_origin(const Surface& s, const Vec3f& w) {
  if (s.lifted && w.dot(s.frame.z) > 0) return s.p + s.lift + s.ng * (s.front ? s.offset : -s.offset);
  return s.p + s.ng * (w.dot(s.ng) < 0 ? -s.offset : s.offset);
}

/// How far along its normal a point of a triangle or parallelogram must move so that a ray from there cannot
/// hit the same plane again: bounds the rounding of interpolating it, of Embree's distance T = (v0 - o) . n,
/// and of the new origin, each a few roundings of numbers up to `extent`, the largest coordinate that went
/// in.
inline float plane_offset(float extent) { return error_gamma(16) * extent; }

/// The same for a point of a solid, given in its own space, and a bound for the error of its position. The
/// intersection and the way to world space are in double precision; what counts is the rounding of the point
/// in both spaces and of the new origin, and that a sphere is round where its map scales alike but for
/// rounding: below 10 units of roundoff of the numbers that are added up, in any direction.
float solid_offset(const Affine& to_world, const Vec3f& point);

/// Emitted radiance of a material at uvs, on a side from which it emits, in a direction whose cosine to the
/// normal of the shape is given. A clear coat lies above what glows and takes what it reflects at that angle
/// (KHR_materials_clearcoat, emission).
Rgb eval_emission(const Scene& scene, const Material& material, const std::array<Vec2f, 2>& uvs,
                  float cosine);

/// Interpolated texture coordinates of a point of a triangle; zero where the primitive has none.
std::array<Vec2f, 2> interpolate_uvs(const Primitive& primitive, const Triangle& triangle, float u, float v);

/// Coverage in [0, 1] of a material at uvs, where the vertex colour's alpha is `alpha`: base colour alpha;
/// for MASK 0 or 1 by the cutoff.
float eval_coverage(const Scene& scene, const Material& material, const std::array<Vec2f, 2>& uvs,
                    float alpha);
/// The same at a point of a triangle.
float eval_coverage(const Scene& scene, const Part& part, std::uint32_t triangle, float u, float v);

}  // namespace parian
