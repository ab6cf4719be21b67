/// The scene as the tracer walks it: the node tree flattened into world space, meshes resolved to arrays and
/// flags.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/medium.h"
#include "renderer/shapes/solid.h"

namespace parian {

/// One primitive of one mesh, or the surface of a solid, resolved, with what a hit on it needs.
struct Part {
  const Primitive* primitive;  // null for a solid
  const Material* material;
  int material_index;
  bool needs_uv;       // a texture of the material will be looked up
  bool needs_color;    // vertex colours are there
  bool needs_tangent;  // a normal map, or anisotropy, needs the tangent
  bool emissive;
  bool bends;           // it mirrors or refracts: shading normals must not send light to the wrong side
  bool extended;        // the material has an extension that shapes its lobes
  std::int32_t medium;  // what the surface bounds, of World::media; kNone: nothing
  // It bounds a medium, and its triangles' fronts are towards that (is_inside_out()).
  bool inside_out;
  bool alpha;    // MASK, or BLEND that is not opaque everywhere: rays are tested in the intersection
  Box3f bounds;  // in object space; of a solid empty
};

/// A mesh drawn once.
struct Placement {
  Affine to_world;
  int node, mesh;            // a mesh of the scene, or, from their number on, one of World::shape_meshes
  std::uint32_t first_part;  // World::parts[first_part + primitive]
  std::uint32_t part_count;
  std::uint32_t first_slot;  // numbers all primitives of all placements in order
  // Rounding: what the map to object space and back does to a point, as a multiple of its coordinates, is
  // bounded by the largest row sum of |M| |M^-1| (Higham, 7.1), and the coordinates by those in object space
  // times `growth`, the largest row sum of |M|, plus the largest of the origin.
  float condition, growth, reach;
  bool identity;

  /// Bounds the world-space coordinates that rounding works on, from those in object space.
  float extent(float object_extent) const { return (1 + condition) * (growth * object_extent + reach); }
};

/// A sphere or frustum drawn once.
struct PlacedSolid {
  Solid solid;
  Affine to_world;
  int node;
  std::uint32_t part;  // World::solid_parts
  // A sphere that to_world leaves a sphere: of this radius, about to_world.origin. Else 0.
  float round_radius;

  bool is_round() const { return round_radius > 0; }
  /// The point, in the solid's own space, where the unit normal of a round sphere is n in world space.
  Vec3f round_point(const Vec3f& n) const {
    // But for a factor the map is its own inverse transpose.
    return project(solid, {n.dot(to_world.x), n.dot(to_world.y), n.dot(to_world.z)}, Face::side);
  }
};

/// A rectangle or disk light, in world space. It emits from the side its normal points to, and is black and
/// opaque from the other. The disk is the ellipse inscribed in the rectangle (a circle, its sides being
/// equal).
struct AreaLight {
  Vec3f center, half_x, half_y, normal;
  Rgb radiance;
  bool disk;
  int node;
};

/// A point, spot or directional light in world space.
struct PunctualLight {
  LightKind kind;
  Vec3f position, direction;  // direction: where it shines
  Rgb intensity;              // W/sr; directional: W/m^2
  float range;                // 0: none
  float cos_inner, cos_outer;
};

struct CameraPlacement {
  int camera, node;
  Affine to_world;  // orthonormal: a camera ignores its node's scale
};

struct World {
  std::vector<Part> parts;
  std::vector<std::uint32_t> first_parts;  // by mesh
  std::vector<Placement> placements;
  std::vector<Part> solid_parts;
  std::vector<PlacedSolid> solids;
  std::vector<std::shared_ptr<const Mesh>> shape_meshes;  // boxes and planes
  std::vector<std::pair<ShapeKind, Vec3f>> shape_sizes;   // of which kind and size each of them is
  std::vector<AreaLight> area_lights;
  std::vector<PunctualLight> punctual_lights;
  std::vector<CameraPlacement> cameras;
  std::vector<Medium> media;  // of the materials that parts use
  std::uint32_t slot_count = 0;
  Box3f bounds;  // of all placed vertices, solids and area lights; empty where there are none

  const Mesh& mesh(const Scene& scene, int index) const {
    const std::size_t i = std::size_t(index), count = scene.meshes.size();
    return i < count ? scene.meshes[i] : *shape_meshes[i - count];
  }
  /// What the surface of a part bounds; null: nothing.
  const Medium* medium(const Part& p) const { return p.medium == kNone ? nullptr : &media[p.medium]; }
  std::size_t mesh_count(const Scene& scene) const { return scene.meshes.size() + shape_meshes.size(); }
  const Part& part(std::uint32_t placement, std::uint32_t primitive) const {
    return parts[placements[placement].first_part + primitive];
  }
};

/// The scene must be valid (validate()) and outlive the result, which points into it. `before`: a world of a
/// scene that is still there; where the arrays of a primitive are the very ones of that scene, what was found
/// out about them is taken over, and boxes and planes of the same sizes share their arrays.
World make_world(const Scene& scene, const World* before = nullptr);

/// The cameras alone.
std::vector<CameraPlacement> place_cameras(const Scene& scene);

/// Gives a scene without camera one that frames what is in it, from slightly above the front, and one without
/// light a plain white sky of radiance 1. Returns a line for each that it added.
std::vector<std::string> add_missing_camera_and_light(Scene& scene);

}  // namespace parian
