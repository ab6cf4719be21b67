/// Every light of the scene in one table: emissive triangles and solids, area lights, punctual lights, the
/// environment. One is chosen with a probability proportional to its power and then sampled.
#pragma once

#include <optional>
#include <vector>

#include "renderer/base/distribution.h"
#include "renderer/base/random.h"
#include "renderer/light/environment.h"
#include "renderer/scene/surface.h"

namespace parian {

/// A direction to a light from the point that was asked for.
struct LightSample {
  Vec3f wi;      // unit
  Rgb radiance;  // arriving along -wi if nothing is between; for a delta light irradiance on a surface across
                 // wi
  float
      pdf;  // per solid angle, choice of the light included; for a delta light the probability of the choice
  bool delta;        // no other strategy can find it
  bool at_infinity;  // directional light or environment: the shadow ray has no end
  Vec3f target;      // else where the shadow ray ends, clear of the light's own surface
};

class LightTable {
 public:
  LightTable() = default;
  /// The scene and world must outlive the table.
  LightTable(const Scene& scene, const World& world);

  bool empty() const { return count_ == 0; }
  int size() const { return count_; }

  /// Samples a light as seen from p, by u in [0,1)^2 and, where there are many lights, one more number of the
  /// sampler. Nothing where the chosen light does not reach p.
  std::optional<LightSample> sample(const Vec3f& p, Vec2f u, Sampler& sampler) const;

  /// Density per solid angle with which sample() from the origin of a ray of unit direction d finds the point
  /// of an emissive triangle that the ray hit, at distance hit.t; `cosine` is |d . ng| there.
  float pdf_triangle(const Hit& hit, float cosine) const;
  /// The same for an emissive solid that a ray from `origin` hit: a round sphere is sampled by its cone of
  /// directions, any other solid by its area.
  float pdf_solid(const Hit& hit, const Vec3f& origin, float cosine) const;
  /// The same for area light hit.triangle.
  float pdf_area_light(const Hit& hit, float cosine) const;
  /// What a ray that left the scene along unit direction d sees, and the density with which sample() finds d.
  EnvironmentSample look_up_environment(const Vec3f& d) const;

  const EnvironmentLight& environment() const { return environment_; }

 private:
  struct EmissiveTriangle {
    Vec3f v0, e1, e2, ng;
    float area, offset;
    const Part* part;
    std::uint32_t triangle;
  };

  void add_placement(const Placement& placement);
  void add_solids();
  template <class UvsAt>
  float mean_emission(const Material& material, const UvsAt& uvs_at) const;
  float power(const EmissiveTriangle& emitter) const;
  float power(const PlacedSolid& solid) const;
  float power(const AreaLight& light) const;
  float power(const PunctualLight& light, float scene_radius) const;
  // Samples of one light, which was chosen with `probability`.
  std::optional<LightSample> sample_emissive(const EmissiveTriangle& emitter, float probability,
                                             const Vec3f& p, const Vec2f& u) const;
  std::optional<LightSample> sample_solid(const PlacedSolid& solid, float probability, const Vec3f& p,
                                          const Vec2f& u) const;
  std::optional<LightSample> sample_area(const AreaLight& light, float probability, const Vec3f& p,
                                         const Vec2f& u) const;
  std::optional<LightSample> sample_punctual(const PunctualLight& light, float probability,
                                             const Vec3f& p) const;
  std::optional<LightSample> sample_environment(float probability, const Vec2f& u) const;
  float choice(int light) const { return count_ == 1 ? 1 : distribution_.probability(light); }

  const Scene* scene_ = nullptr;
  const World* world_ = nullptr;
  std::vector<EmissiveTriangle> triangles_;
  std::vector<std::uint32_t> first_triangle_;  // by slot; empty where no mesh emits
  std::vector<std::uint32_t> solids_;          // those that emit, as indices into World::solids
  std::vector<std::uint32_t> solid_lights_;    // by solid: its place in solids_; empty where none emits
  EnvironmentLight environment_;
  // Lights are numbered: triangles, solids, area lights, punctual lights, environment.
  int first_solid_ = 0, first_area_ = 0, first_punctual_ = 0, environment_index_ = 0, count_ = 0;
  Distribution1D distribution_;
};

}  // namespace parian
