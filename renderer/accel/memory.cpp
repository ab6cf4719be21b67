/// find_mesh_uses() and estimate_memory().
#include <algorithm>

#include "renderer/accel/mesh_uses.h"
#include "renderer/accel/triangle_pairs.h"

namespace parian {
namespace {

// Fewer triangles than this share of them with a partner, and quads take more memory than they save. And in
// small scenes, whose memory is nothing, packets of rays take up to 3% longer for quads.
constexpr double kLeastPaired = 0.6, kLeastTriangles = 1000;

// Bytes for each primitive, measured (docs/large.md): what Embree holds, and what it takes beside that
// while it builds.
struct Cost {
  double held, building;
};

Cost cost_of(bool quads, const AccelSettings& settings) {
  const bool fast = settings.quality == BuildQuality::fast;
  if (quads && fast) return settings.compact ? Cost{107, 8} : Cost{114, 6};
  if (quads) return settings.compact ? Cost{36.5, 37} : Cost{78, 30};
  if (fast) return settings.compact ? Cost{50, 10} : Cost{93, 9};
  return settings.compact ? Cost{37, 3} : Cost{65, 34};
}

// Of a scene to be edited, meshes of this many triangles and more are built quickly first, and better once
// the picture shows them.
constexpr std::size_t kQuickFrom = 100'000;

constexpr double kPairBytes = sizeof(Quad), kOriginBytes = sizeof(PairOrigin);
// Above this many triangles the copies of a mesh cost more than its instances.
constexpr double kMostCopied = 4e6;
constexpr double kInstanceBytes = 400, kSolidBytes = 110;

/// Of one placement: its triangles, or the quads that they are traced as.
double count_primitives(const World& world, const Placement& p, bool paired) {
  double count = 0;
  for (std::uint32_t i = p.first_part; i < p.first_part + p.part_count; ++i) {
    const SharedArray<Triangle>& triangles = world.parts[i].primitive->triangles;
    count += paired ? estimate_quads(triangles) : double(triangles.size());
  }
  return count;
}

/// How a mesh is drawn.
struct Drawn {
  const Placement* first = nullptr;
  std::size_t times = 0;
  double triangles = 0;
};

std::vector<Drawn> count_meshes(const Scene& scene, const World& world) {
  std::vector<Drawn> meshes(world.mesh_count(scene));
  for (const Placement& p : world.placements) {
    Drawn& mesh = meshes[p.mesh];
    if (mesh.times++ > 0) continue;
    mesh.first = &p;
    mesh.triangles = count_primitives(world, p, false);
  }
  return meshes;
}

/// Whether triangles are better traced in pairs.
struct Pairing {
  double triangles = 0, quads = 0;

  void add(std::span<const Part> parts) {
    for (const Part& part : parts) {
      triangles += double(part.primitive->triangles.size());
      quads += estimate_quads(part.primitive->triangles);
    }
  }
  bool pays() const {
    return triangles >= kLeastTriangles && 2 * (triangles - quads) >= kLeastPaired * triangles;
  }
};

bool is_copied(const Drawn& mesh) { return double(mesh.times) * mesh.triangles <= kMostCopied; }

}  // namespace

MeshUses find_mesh_uses(const Scene& scene, const World& world, const AccelSettings& settings) {
  const std::vector<Drawn> meshes = count_meshes(scene, world);
  const bool copies = settings.quality == BuildQuality::best && !settings.editable;
  MeshUses uses;
  for (const Drawn& mesh : meshes)
    uses.instanced.push_back(mesh.times > 1 ? !(copies && is_copied(mesh))
                                            : settings.editable && mesh.times > 0);
  if (settings.editable) return uses;
  Pairing pairing;
  for (const Placement& p : world.placements)
    if (meshes[p.mesh].first == &p) pairing.add(std::span(world.parts).subspan(p.first_part, p.part_count));
  uses.paired = pairing.pays();
  return uses;
}

BuildQuality first_quality(std::span<const Part> parts, const AccelSettings& settings) {
  std::size_t triangles = 0;
  for (const Part& part : parts) triangles += part.primitive->triangles.size();
  return settings.editable && triangles >= kQuickFrom ? BuildQuality::fast : settings.quality;
}

bool pays_to_pair(std::span<const Part> parts) {
  Pairing pairing;
  pairing.add(parts);
  return pairing.pays();
}

double copied_triangles(const Scene& scene, const World& world) {
  double copied = 0;
  for (const Drawn& mesh : count_meshes(scene, world))
    if (mesh.times > 1 && is_copied(mesh)) copied += double(mesh.times) * mesh.triangles;
  return copied;
}

AccelMemory estimate_memory(const Scene& scene, const World& world, const AccelSettings& settings) {
  const MeshUses uses = find_mesh_uses(scene, world, settings);
  Cost cost = cost_of(uses.paired, settings);
  std::vector<double> primitives(uses.instanced.size(), -1);  // by mesh; -1: not yet met
  double held = 0, after = 0;                                 // bytes during the builds, and made after them
  double largest = 0, top = 0;  // primitives of the largest mesh that is built alone, of the rest
  std::size_t instances = 0;
  for (const Placement& p : world.placements) {
    const bool instanced = uses.instanced[p.mesh], is_new = primitives[p.mesh] < 0;
    double& count = primitives[p.mesh];
    if (is_new) {
      const auto parts = std::span(world.parts).subspan(p.first_part, p.part_count);
      const bool paired = settings.editable ? pays_to_pair(parts) : uses.paired;
      if (settings.editable) {
        AccelSettings first = settings;
        first.quality = first_quality(parts, settings);
        cost = cost_of(paired, first);
      }
      count = count_primitives(world, p, paired);
      if (paired) held += kPairBytes * count;
      if (paired) after += kOriginBytes * count;
    }
    instances += instanced;
    if (instanced && !is_new) continue;
    held += cost.held * count;
    for (std::uint32_t i = p.first_part; i < p.first_part + p.part_count; ++i) {
      const SharedArray<Vec3f>& positions = world.parts[i].primitive->positions;
      if (copies_vertices(positions, instanced || p.identity ? nullptr : &p.to_world))
        held += double(positions.bytes());
    }
    if (instanced)
      largest = std::max(largest, count);
    else
      top += count;
  }
  held += kInstanceBytes * double(instances) + kSolidBytes * double(world.solids.size());
  // With several meshes in a scene to be edited, that of the last: they are alike but for small ones.
  const double building = cost.building * std::max(largest, top);
  return {std::size_t(held + after), std::size_t(held + std::max(after, building))};
}

}  // namespace parian
