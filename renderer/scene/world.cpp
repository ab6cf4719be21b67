#include "renderer/scene/world.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "renderer/base/parallel.h"
#include "renderer/scene/orientation.h"
#include "renderer/scene/shape_meshes.h"

namespace parian {
namespace {

/// `colored`: there are vertex colours.
bool has_alpha(const Material& material, bool colored) {
  if (material.alpha_mode == AlphaMode::opaque) return false;
  return material.alpha < 1 || material.base_color_texture || colored ||
         (material.alpha_mode == AlphaMode::mask && material.alpha_cutoff > 1);
}

bool uses_texture(const Material& m) {
  bool any = false;
  for_each_texture(m, [&](const TextureRef& texture) { any = any || texture; });
  return any;
}

/// Of a primitive, or, where that is null, a solid.
Part make_part(const Scene& scene, const Primitive* primitive, int material) {
  const Material& m = scene.materials[material];
  const bool colored = primitive && !primitive->colors.empty();
  return {.primitive = primitive,
          .material = &m,
          .material_index = material,
          .needs_uv = uses_texture(m),
          .needs_color = colored,
          .needs_tangent = m.normal_texture || (m.anisotropy && m.anisotropy->strength > 0) ||
                           (m.clearcoat && m.clearcoat->normal_texture),
          .emissive = !is_black(m.emission) && !m.unlit,
          .bends = m.transmission || m.conductor || m.subsurface,
          .extended = m.transmission || m.diffuse_transmission || m.clearcoat || m.sheen || m.anisotropy ||
                      m.iridescence || m.phong || m.conductor || m.subsurface,
          .medium = kNone,
          .inside_out = false,
          .alpha = has_alpha(m, colored),
          .bounds = {}};
}

/// The largest row sum of |M| |M^-1|.
float condition_number(const Mat4d& matrix) {
  const Mat4d inverse = matrix.inverse();
  double worst = 0;
  for (int i = 0; i < 3; ++i) {
    double sum = 0;
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) sum += std::abs(matrix[k][i]) * std::abs(inverse[j][k]);
    worst = std::max(worst, sum);
  }
  return float(worst);
}

bool is_identity(const Affine& a) { return a == Affine{}; }

/// The factor by which the map scales all lengths; 0 where it does not scale all alike, but for rounding.
float uniform_scale(const Affine& a) {
  constexpr double kTolerance = 3e-7;
  const Vec3d x(a.x), y(a.y), z(a.z);
  const double xx = x.dot(x), least = kTolerance * xx;
  const bool uniform = std::abs(y.dot(y) - xx) <= least && std::abs(z.dot(z) - xx) <= least &&
                       std::abs(x.dot(y)) <= least && std::abs(y.dot(z)) <= least &&
                       std::abs(z.dot(x)) <= least;
  return uniform ? float(std::sqrt(xx)) : 0;
}

Solid to_solid(const Shape& shape) {
  if (shape.kind == ShapeKind::sphere) return Sphere{shape.radius};
  return Frustum{shape.radius_bottom, shape.radius_top, shape.height};
}

/// The map with its scale and shear taken out: x, y and z orthonormal, z keeping its direction.
Affine orthonormal(const Affine& a) {
  const Vec3f z = a.z.normalized();
  const Vec3f x = a.y.cross(z).normalized();
  return {x, z.cross(x), z, a.origin};
}

AreaLight make_area_light(const Light& light, const Affine& to_world, int node) {
  // EXT_lights_area: the size scales with the largest component of the node's scale, always uniformly.
  const Affine axes = orthonormal(to_world);
  const float scale = std::max({to_world.x.length(), to_world.y.length(), to_world.z.length()});
  const bool disk = light.kind == LightKind::disk;
  const float half_x = 0.5f * scale * light.width,
              half_y = 0.5f * scale * (disk ? light.width : light.height);
  return {axes.origin, axes.x * half_x, axes.y * half_y, -axes.z, light.color * light.intensity, disk, node};
}

PunctualLight make_punctual_light(const Light& light, const Affine& to_world) {
  return {light.kind,
          to_world.origin,
          -to_world.z.normalized(),
          light.color * light.intensity,
          light.range,
          std::cos(light.inner_angle),
          std::cos(light.outer_angle)};
}

/// Calls visit(node index, node to world, whether it is visible) for every node below the roots, parents
/// first.
template <class Visit>
void for_each_node(const Scene& scene, const Visit& visit) {
  struct Open {
    int index;
    Mat4d parent;
    bool visible;
  };
  std::vector<Open> open;
  for (auto root = scene.roots.rbegin(); root != scene.roots.rend(); ++root)
    open.push_back({*root, Mat4d(), true});
  while (!open.empty()) {
    const Open next = open.back();
    open.pop_back();
    const Node& node = scene.nodes[next.index];
    const Mat4d to_world = node.transform.to_matrix() * next.parent;
    const bool visible = next.visible && node.visible;
    visit(next.index, to_world, visible);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child)
      open.push_back({*child, to_world, visible});
  }
}

Box3f vertex_bounds(const Primitive& primitive) {
  Box3f box;
  for (const Vec3f& p : primitive.positions) box.extendBy(p);
  return box;
}

/// Whether the arrays are the very same.
bool same_arrays(const Primitive& a, const Primitive& b) {
  return a.positions.data() == b.positions.data() && a.positions.size() == b.positions.size() &&
         a.triangles.data() == b.triangles.data() && a.triangles.size() == b.triangles.size();
}

/// What a world knows of its primitives, by their arrays.
class KnownParts {
 public:
  explicit KnownParts(const World* world) {
    if (!world) return;
    for (std::size_t i = 0; i < world->parts.size(); ++i)
      parts_.emplace(world->parts[i].primitive->triangles.data(), &world->parts[i]);
    for (std::size_t i = 0; i < world->shape_meshes.size(); ++i)
      shapes_.emplace(key(world->shape_sizes[i]), &world->shape_meshes[i]->primitives[0]);
  }

  /// One of the same arrays; of the same material, where there is one. Null: there is none.
  const Part* find(const Primitive& primitive) const {
    const Part* any = nullptr;
    const auto [begin, end] = parts_.equal_range(primitive.triangles.data());
    for (auto known = begin; known != end; ++known) {
      if (!same_arrays(*known->second->primitive, primitive)) continue;
      any = known->second;
      if (any->material_index == primitive.material) break;
    }
    return any;
  }
  /// The primitive of a box or plane of that kind and size; null: there is none.
  const Primitive* find(const std::pair<ShapeKind, Vec3f>& shape) const {
    const auto known = shapes_.find(key(shape));
    return known == shapes_.end() ? nullptr : known->second;
  }

 private:
  using ShapeKey = std::tuple<ShapeKind, float, float, float>;
  static ShapeKey key(const std::pair<ShapeKind, Vec3f>& shape) {
    return {shape.first, shape.second.x, shape.second.y, shape.second.z};
  }
  std::unordered_multimap<const Triangle*, const Part*> parts_;
  std::map<ShapeKey, const Primitive*> shapes_;
};

class WorldBuilder {
 public:
  WorldBuilder(const Scene& scene, const World* before) : scene_(scene), before_(before), known_(before) {
    for (const Mesh& mesh : scene.meshes) {
      world_.first_parts.push_back(std::uint32_t(world_.parts.size()));
      for (const Primitive& primitive : mesh.primitives)
        world_.parts.push_back(make_part(scene, &primitive, primitive.material));
    }
    parallel_for(world_.parts.size(), 1, [&](std::size_t i) {
      Part& part = world_.parts[i];
      const Part* known = known_.find(*part.primitive);
      part.bounds = known ? known->bounds : vertex_bounds(*part.primitive);
    });
  }

  World build() && {
    for_each_node(scene_, [&](int index, const Mat4d& to_world, bool visible) {
      if (visible) add_node(scene_.nodes[index], index, to_world);
    });
    world_.cameras = place_cameras(scene_);
    for (std::vector<Part>* parts : {&world_.parts, &world_.solid_parts})
      for (Part& part : *parts) part.medium = medium_of(part);
    if (!world_.media.empty()) find_orientations();
    return std::move(world_);
  }

 private:
  /// The medium that a part bounds, one for each material that has an interior.
  std::int32_t medium_of(const Part& part) {
    if (!part.material->has_interior()) return kNone;
    const auto [known, is_new] = media_.try_emplace(part.material_index, std::int32_t(world_.media.size()));
    if (is_new) world_.media.push_back(make_medium(*part.material));
    return known->second;
  }

  /// Of what in each mesh bounds one medium.
  void find_orientations() {
    for (std::size_t mesh = 0; mesh < world_.first_parts.size(); ++mesh) {
      const std::size_t end =
          mesh + 1 < world_.first_parts.size() ? world_.first_parts[mesh + 1] : world_.parts.size();
      std::map<std::int32_t, std::vector<const Primitive*>> bodies;
      const auto parts =
          std::span(world_.parts).subspan(world_.first_parts[mesh], end - world_.first_parts[mesh]);
      for (const Part& part : parts)
        if (part.medium != kNone) bodies[part.medium].push_back(part.primitive);
      if (!bodies.empty() && take_over_orientations(parts)) continue;
      for (const auto& [medium, primitives] : bodies)
        if (is_inside_out(primitives))
          for (Part& part : parts) part.inside_out |= part.medium == medium;
    }
  }

  /// Of a mesh that is in the world before with the same materials, side by side, and the same of its parts
  /// bounding media; false where it is not.
  bool take_over_orientations(std::span<Part> parts) const {
    const Part* first = known_.find(*parts[0].primitive);
    if (!first) return false;
    const auto begin = std::uint32_t(first - before_->parts.data());
    const auto mesh = std::ranges::lower_bound(before_->first_parts, begin);  // none, or empty ones, or it
    const auto next = std::ranges::upper_bound(before_->first_parts, begin);
    const std::size_t end = next == before_->first_parts.end() ? before_->parts.size() : *next;
    if (mesh == before_->first_parts.end() || *mesh != begin || end - begin != parts.size()) return false;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (!same_arrays(*first[i].primitive, *parts[i].primitive) ||
          first[i].material_index != parts[i].material_index ||
          (first[i].medium == kNone) != (parts[i].medium == kNone))
        return false;
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i].inside_out = first[i].inside_out;
    return true;
  }

  void add_node(const Node& node, int index, const Mat4d& to_world) {
    if (node.shape != kNone && node.instances.size() > world_.solids.capacity())
      world_.solids.reserve(world_.solids.size() + node.instances.size());
    if (node.instances.empty()) add_geometry(node, index, to_world);
    for (const InstanceTransform& instance : node.instances)
      add_geometry(node, index, instance.to_matrix() * to_world);
    if (node.light != kNone) add_light(scene_.lights[node.light], index, to_affine(to_world));
  }

  void add_geometry(const Node& node, int index, const Mat4d& to_world) {
    // A scale of zero along an axis leaves nothing that a ray could hit: the node is hidden.
    if (to_affine(to_world).determinant() == 0) return;
    if (node.mesh != kNone) add_mesh(node.mesh, index, to_world);
    if (node.shape == kNone) return;
    const ShapeKind kind = scene_.shapes[node.shape].kind;
    if (kind == ShapeKind::box || kind == ShapeKind::plane)
      add_mesh(shape_mesh(node.shape, node.shape_material), index, to_world);
    else
      add_solid(node, index, to_affine(to_world));
  }

  void add_mesh(int mesh, int node, const Mat4d& matrix) {
    const Affine to_world = to_affine(matrix);
    const bool identity = is_identity(to_world);
    const auto parts = std::uint32_t(world_.mesh(scene_, mesh).primitives.size());
    world_.placements.push_back({to_world, node, mesh, world_.first_parts[mesh], parts, world_.slot_count,
                                 identity ? 0 : condition_number(matrix),
                                 max_component(abs(to_world.x) + abs(to_world.y) + abs(to_world.z)),
                                 max_component(abs(to_world.origin)), identity});
    for (std::size_t i = 0; i < parts; ++i) {
      const Box3f& box = world_.parts[world_.first_parts[mesh] + i].bounds;
      if (box.isEmpty()) continue;
      for (int corner = 0; corner < 8; ++corner)
        world_.bounds.extendBy(
            to_world.point({corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                            corner & 4 ? box.max.z : box.min.z}));
    }
    world_.slot_count += parts;
  }

  /// The mesh of a box or plane, made when it is first drawn with that material.
  int shape_mesh(int shape, int material) {
    const auto [known, is_new] = shape_meshes_.try_emplace({shape, material}, int(world_.mesh_count(scene_)));
    if (is_new) {
      Mesh mesh;
      const std::pair size(scene_.shapes[shape].kind, scene_.shapes[shape].size);
      const Primitive* known_primitive = known_.find(size);
      mesh.primitives.push_back(known_primitive ? *known_primitive
                                                : make_shape_primitive(scene_.shapes[shape], material));
      mesh.primitives[0].material = material;
      world_.shape_sizes.push_back(size);
      world_.shape_meshes.push_back(std::make_shared<const Mesh>(std::move(mesh)));
      const Primitive& primitive = world_.shape_meshes.back()->primitives[0];
      world_.first_parts.push_back(std::uint32_t(world_.parts.size()));
      world_.parts.push_back(make_part(scene_, &primitive, material));
      world_.parts.back().bounds = vertex_bounds(primitive);
    }
    return known->second;
  }

  void add_solid(const Node& node, int index, const Affine& to_world) {
    const auto [part, is_new] =
        solid_parts_.try_emplace(node.shape_material, std::uint32_t(world_.solid_parts.size()));
    if (is_new) world_.solid_parts.push_back(make_part(scene_, nullptr, node.shape_material));
    const Shape& shape = scene_.shapes[node.shape];
    const float round_radius = shape.kind == ShapeKind::sphere ? shape.radius * uniform_scale(to_world) : 0;
    world_.solids.push_back({to_solid(shape), to_world, index, part->second, round_radius});
    world_.bounds.extendBy(bounds(world_.solids.back().solid, to_world));
  }

  void add_light(const Light& light, int node, const Affine& to_world) {
    if (light.kind == LightKind::rectangle || light.kind == LightKind::disk) {
      const AreaLight area = make_area_light(light, to_world, node);
      for (int corner = 0; corner < 4; ++corner)
        world_.bounds.extendBy(area.center + area.half_x * (corner & 1 ? 1 : -1) +
                               area.half_y * (corner & 2 ? 1 : -1));
      world_.area_lights.push_back(area);
    } else {
      world_.punctual_lights.push_back(make_punctual_light(light, to_world));
    }
  }

  const Scene& scene_;
  const World* before_;
  KnownParts known_;
  World world_;
  std::map<std::pair<int, int>, int> shape_meshes_;  // by shape and material
  std::map<int, std::int32_t> media_;                // by material
  std::map<int, std::uint32_t> solid_parts_;         // by material
};

bool has_light(const Scene& scene, const World& world) {
  if (!world.area_lights.empty() || !world.punctual_lights.empty() || !is_black(scene.environment.radiance))
    return true;
  for (const Placement& p : world.placements)
    for (std::uint32_t i = 0; i < p.part_count; ++i) {
      const Part& part = world.parts[p.first_part + i];
      if (part.emissive || part.material->unlit) return true;
    }
  return std::ranges::any_of(world.solid_parts,
                             [](const Part& part) { return part.emissive || part.material->unlit; });
}

/// A camera of 40 degrees, 30 degrees to the side and 20 above, that has the bounding sphere in its view.
void add_framing_camera(Scene& scene, const Box3f& bounds) {
  const Vec3f center = bounds.isEmpty() ? Vec3f(0) : bounds.center();
  const float radius = bounds.isEmpty() ? 1 : std::max(0.5f * bounds.size().length(), 1e-6f);
  const Vec3f back = Vec3f(0.47f, 0.342f, 0.814f).normalized();
  const float yfov = 0.7f, distance = radius / std::sin(0.5f * yfov);
  const Vec3f x = Vec3f(0, 1, 0).cross(back).normalized(), y = back.cross(x), eye = center + back * distance;

  Node node;
  node.name = "framing camera";
  node.transform.matrix =
      Imath::M44f(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, back.x, back.y, back.z, 0, eye.x, eye.y, eye.z, 1);
  node.camera = int(scene.cameras.size());
  Camera camera;
  camera.name = node.name;
  camera.yfov = yfov;
  scene.cameras.push_back(camera);
  scene.roots.push_back(int(scene.nodes.size()));
  scene.nodes.push_back(node);
}

}  // namespace

World make_world(const Scene& scene, const World* before) { return WorldBuilder(scene, before).build(); }

std::vector<CameraPlacement> place_cameras(const Scene& scene) {
  std::vector<CameraPlacement> cameras;
  for_each_node(scene, [&](int index, const Mat4d& to_world, bool) {
    const int camera = scene.nodes[index].camera;
    if (camera != kNone) cameras.push_back({camera, index, orthonormal(to_affine(to_world))});
  });
  return cameras;
}

std::vector<std::string> add_missing_camera_and_light(Scene& scene) {
  std::vector<std::string> notes;
  if (!place_cameras(scene).empty() && !is_black(scene.environment.radiance)) return notes;
  const World world = make_world(scene);
  if (world.cameras.empty()) {
    add_framing_camera(scene, world.bounds);
    notes.push_back("no camera in the scene: added one that frames it");
  }
  if (!has_light(scene, world)) {
    scene.environment.radiance = Rgb(1, 1, 1);
    notes.push_back("no light in the scene: added a plain white sky");
  }
  return notes;
}

}  // namespace parian
