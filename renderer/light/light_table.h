/// Every light of the scene in one table: emissive triangles and solids, area lights, punctual lights, the
/// environment. One is chosen for the receiver and then sampled.
#pragma once

#include <optional>
#include <vector>

#include "renderer/base/random.h"
#include "renderer/light/emissive_triangles.h"
#include "renderer/light/environment.h"
#include "renderer/light/light_choice.h"

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
  LightTable(const Scene& scene, const World& world, LightChoice choice = LightChoice::tree);

  /// Takes on an edited scene if its lights are as they were; false, and nothing is done, where they are not.
  /// The scene and world before must still be there. The table is then, to the bit, the one that would be
  /// made of the edited scene.
  bool rebind(const Scene& scene, const World& world);

  bool empty() const { return count_ == 0; }
  int size() const { return count_; }
  /// Memory of the lights and of the choice among them, but for the environment map's own density.
  std::size_t bytes() const;

  /// Samples a light for a receiver, by u in [0,1)^2 and, where there are many lights, one more pair of
  /// numbers of the sampler. Nothing where the chosen light does not reach it.
  std::optional<LightSample> sample(const Receiver& to, Vec2f u, Sampler& sampler) const;

  /// Density per solid angle with which sample() for a receiver finds the point of an emissive triangle that
  /// a ray of unit direction d from there hit, at distance hit.t; `cosine` is |d . ng| there.
  float pdf_triangle(const Hit& hit, const Receiver& to, float cosine) const;
  /// The same for an emissive solid: a round sphere is sampled by its cone of directions, any other solid by
  /// its area.
  float pdf_solid(const Hit& hit, const Receiver& to, float cosine) const;
  /// The same for area light hit.triangle.
  float pdf_area_light(const Hit& hit, const Receiver& to, float cosine) const;
  /// What a ray that left the scene along unit direction d sees, and the density with which sample() finds d.
  EnvironmentSample look_up_environment(const Vec3f& d, const Receiver& to) const;

  const EnvironmentLight& environment() const { return environment_; }
  const LightChooser& chooser() const { return chooser_; }

 private:
  void add_solids();
  LightChooser make_chooser(LightChoice choice) const;
  /// The coordinates of a point of a solid, for each set.
  static std::array<Vec2f, 2> solid_uvs(const PlacedSolid& placed, const SurfaceSample& point);
  template <class UvsAt>
  float mean_emission(const Material& material, int points, const UvsAt& uvs_at) const;
  float power(const EmissiveTriangle& emitter) const;
  float power(const PlacedSolid& solid) const;
  float power(const AreaLight& light) const;
  float power(const PunctualLight& light, float scene_radius) const;
  float power(int light) const;
  std::vector<float> powers() const;
  // Those of lights that have no place are of no intensity.
  LightBounds bounds(const EmissiveTriangle& emitter) const;
  LightBounds bounds(const PlacedSolid& solid) const;
  LightBounds bounds(const AreaLight& light) const;
  LightBounds bounds(const PunctualLight& light) const;
  LightBounds bounds(int light) const;
  std::vector<InfiniteLight> infinite_lights() const;
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
  float choice(const Receiver& to, int light) const {
    return count_ == 1 ? 1 : chooser_.probability(to, light);
  }

  const Scene* scene_ = nullptr;
  const World* world_ = nullptr;
  EmissiveTriangles triangles_;
  std::vector<std::uint32_t> solids_;        // those that emit, as indices into World::solids
  std::vector<std::uint32_t> solid_lights_;  // by solid: its place in solids_; empty where none emits
  EnvironmentLight environment_;
  // Lights are numbered: triangles, solids, area lights, punctual lights, environment.
  int first_solid_ = 0, first_area_ = 0, first_punctual_ = 0, environment_index_ = 0, count_ = 0;
  LightChooser chooser_;
};

/// Bytes of a light table, and the most that building it takes on the way, that included.
struct LightTableBytes {
  std::size_t held = 0, peak = 0;
};

/// What LightTable::bytes() will be for a scene of that many emissive triangles of `slots` placed primitives
/// that emit, to 10% where there are more than LightTree::kPacked. Other lights count as triangles.
LightTableBytes light_table_bytes(std::size_t lights, LightChoice choice, std::size_t slots = 1);

}  // namespace parian
