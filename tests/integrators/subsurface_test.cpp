// Diffusion by probe rays: closed forms of the dipole on simple bodies, and bodies that are not.
#include "integrators/subsurface.h"

#include <gtest/gtest.h>

#include "renderer/scene/half_space.h"
#include "tests/integrators/support/bodies.h"
#include "tests/integrators/support/render.h"
#include "tests/support/classical_dipole.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// The classical dipole of index 1.3 in metres, integrated by hand.
struct Dipole {
  double absorption, scattering;

  double extinction() const { return absorption + scattering; }
  DipoleByHand in_free_paths() const { return {scattering / extinction()}; }
  double reflectance() const { return in_free_paths().total(); }
  /// The share that comes out farther than r from where it went in, on a plane.
  double beyond(double r) const { return in_free_paths().beyond(r * extinction()); }
  double within(double r) const { return 1 - beyond(r); }
  /// The share that comes out beyond a straight line at distance h.
  double beyond_line(double h) const {
    // By the angle of the place: those within acos(h / r) of the line's normal, by parts.
    constexpr int kSteps = 20000;
    double sum = 0, before = beyond(h);
    for (int i = 1; i <= kSteps; ++i) {
      const double r = h + 100 * h * std::pow(i / double(kSteps), 3) + 30 / extinction() * i / kSteps;
      const double now = beyond(r), middle = std::acos(std::min(1.0, h / r)) / std::numbers::pi;
      sum += (before - now) * middle;
      before = now;
    }
    return sum + before / 2;
  }
};

Dipole channel(const Material& m, int k) {
  return {m.subsurface->absorption[k], m.subsurface->reduced_scattering[k]};
}

Picture diffused(const Scene& scene, int spp, Subsurface method = Subsurface::dipole, int side = 16) {
  return render(scene, independent_settings(side, side, std::uint32_t(spp)), with(method));
}

/// Three albedos and mean free paths in one.
Material make_tricolour() { return make_dense({0.01f, 0.1f, 0.005f}, {0.99f, 0.9f, 1.995f}, 1.3f); }

// The tests' own formulas, against published integrals.
TEST(DipoleByHand, IsTheKnownOne) {
  const Dipole d{0.01, 0.99};
  EXPECT_NEAR(d.reflectance(), 0.6446, 5e-5);
  EXPECT_NEAR(d.within(2), 0.4666, 5e-5);
  EXPECT_NEAR(d.within(20), 0.9940, 5e-5);
  EXPECT_NEAR(1 - d.beyond_line(1) + d.beyond(1) / 2, 1.103, 1e-3);
}

// Wrong variants that this sees: one axis alone or no multiple importance sampling (fireflies, and dark
// rims), hits not counted (half), the cosine to the axis omitted (a factor of 1.9), the first hit alone,
// channels counted that cannot reach.
TEST(Diffusion, OnASphereIsTheShareWithinItsDiameter) {
  const Material m = make_tricolour();
  for (const float radius : {1.0f, 3.0f, 10.0f}) {
    Scene scene;
    add_shape(scene, make_sphere(radius), add_material(scene, m));
    set_white_sky(scene);
    add_probe(scene, {0, 0, radius}, {0, 0, 1}, 3, 1e-3f);
    const Picture p = diffused(scene, 1024);
    for (int k = 0; k < 3; ++k) {
      const Dipole d = channel(m, k);
      EXPECT_TRUE(mean_is(mean_of(p, k), seen(1.3, d.reflectance() * d.within(2 * radius)), 0.02))
          << radius << " " << k;
    }
  }
}

// A channel whose profile ends early must not be counted where only another's probe can reach: here red light
// goes a hundred times as far as the others.
TEST(Diffusion, CountsOnlyChannelsWhoseProbeReaches) {
  const Material m = make_dense({0.01f, 1, 1}, {0.09f, 9, 9}, 1.3f);
  Scene scene;
  add_shape(scene, make_sphere(20), add_material(scene, m));
  set_white_sky(scene);
  add_probe(scene, {0, 0, 20}, {0, 0, 1}, 3, 1e-3f);
  const Dipole d = channel(m, 0);
  EXPECT_TRUE(mean_is(mean_of(diffused(scene, 1024), 0), seen(1.3, d.reflectance() * d.within(40)), 0.03));
}

// The same sphere, scaled up to its size; as a mesh, drawn twice; and turned inside out.
TEST(Diffusion, IsInMetresOfTheSceneWhateverTheInstance) {
  const Dipole d{0.01, 0.99};
  const double truth = seen(1.3, d.reflectance() * d.within(6));
  for (const int variant : {0, 1, 2}) {
    Scene scene;
    const int material = add_material(scene, make_dense(0.99f, 1.3f));
    Transform grown;
    grown.scale = Vec3f(6);
    if (variant == 0) {
      add_shape(scene, make_sphere(0.5f), material, grown);
    } else {
      Primitive sphere = make_uv_sphere({0, 0, 0}, 0.5f, 128);
      if (variant == 2) {
        std::vector<Triangle> turned(sphere.triangles.begin(), sphere.triangles.end());
        for (Triangle& t : turned) std::swap(t[1], t[2]);
        sphere.triangles = turned;
      }
      add_mesh(scene, sphere, material, grown);
      Node again;
      again.mesh = 0;
      again.transform = translate({40, 0, 0});
      add_root(scene, again);
    }
    set_white_sky(scene);
    add_probe(scene, Vec3f(1, 0.5f, 2).normalized() * 3, Vec3f(1, 0.5f, 2), 3, 1e-3f);
    EXPECT_TRUE(mean_is(mean_of(diffused(scene, 1024), 0), truth, 0.015)) << variant;
  }
}

TEST(Diffusion, ThroughASlabReachesItsOtherFace) {
  const Material m = make_tricolour();
  for (const float thickness : {0.5f, 2.0f}) {
    Scene scene;
    add_block(scene, m, thickness);
    set_white_sky(scene);
    add_probe_above(scene, {0, 0, 0});
    const Picture p = diffused(scene, 1024);
    for (int k = 0; k < 3; ++k) {
      const Dipole d = channel(m, k);
      const double truth = seen(1.3, d.reflectance() * (2 - d.within(thickness)));
      EXPECT_TRUE(mean_is(mean_of(p, k), truth, 0.02)) << thickness << " " << k;
    }
  }
}

// At a right-angled edge probes along the normal alone would miss the other face: 49% too dark at a tenth of
// a mean free path.
TEST(Diffusion, AtAnEdgeFindsTheOtherFace) {
  const Dipole d{0.01, 0.99};
  for (const double h : {0.1, 1.0, 5.0}) {
    Scene scene;
    add_block(scene, make_dense(0.99f, 1.3f), 1000);
    set_white_sky(scene);
    add_probe_above(scene, {float(1000 - h), 0, 0});
    const double truth = seen(1.3, d.reflectance() * (1 - d.beyond_line(h) + d.beyond(h) / 2));
    EXPECT_TRUE(mean_is(mean_of(diffused(scene, 1024), 0), truth, 0.015)) << h;
  }
}

// Two blocks of one material that touch: the sky that the one sees does not go through to the other.
TEST(Diffusion, StaysInItsBody) {
  Scene scene;
  const int material = add_material(scene, make_dense(0.99f, 1.3f));
  add_mesh(scene, make_box({0, -50, -50}, {50, 0, 50}), material);
  add_mesh(scene, make_box({-50, -50, -50}, {0, 0, 50}), material);
  Light sun;
  sun.kind = LightKind::directional;
  add_light(scene, sun, look_along({0, 0, 0}, {0, -1, 0}));
  // In its shadow: x > 0.
  add_mesh(scene, make_box({0, 10, -60}, {60, 11, 60}), add_material(scene, make_lambert({0, 0, 0})));
  add_probe_above(scene, {0.5f, 0, 0});
  EXPECT_EQ(mean_of(diffused(scene, 64), 0).value, 0);
}

/// A context to call sample_emergence() in.
struct Laboratory {
  Scene scene;
  World world;
  Accel accel;
  LightTable lights;
  MediumStack air;
  explicit Laboratory(Scene s)
      : scene(std::move(s)), world(make_world(scene)), accel(scene, world, {}), lights(scene, world) {}
  TraceContext context() const { return {scene, world, accel, lights, air}; }
};

// On a plane, by the means of weights: each radius holds its share, and no weight is above four times the
// reflectance, which that of the axis nearest to the normal bounds.
TEST(Emergence, IsDistributedAsTheProfile) {
  Scene scene;
  const Material m = make_tricolour();
  add_block(scene, m, 1000);
  const Laboratory lab(std::move(scene));
  const std::vector<DiffuseMedium> media = make_diffuse_media(lab.world, Subsurface::dipole);
  Hit hit;
  ASSERT_TRUE(lab.accel.intersect({{0.2f, 5, 0.1f}, {0, -1, 0}}, 0, hit));
  const Surface entry = make_surface(lab.scene, lab.world, hit, {0, -1, 0});
  constexpr std::array<double, 4> kRadii{0.3, 1, 3, 10};
  std::array<std::array<Statistics, 4>, 3> shares;
  double largest = 0;
  for (std::uint32_t i = 0; i < 60000; ++i) {
    Sampler sampler(SamplerKind::independent, 7, i);
    const auto place = sample_emergence(lab.context(), media[0], entry, hit, Rgb(1, 1, 1), sampler);
    for (int k = 0; k < 3; ++k) {
      const double weight = place ? place->weight[k] : 0;
      largest = std::max(largest, weight);
      for (std::size_t j = 0; j < kRadii.size(); ++j)
        shares[std::size_t(k)][j].add(place && (place->surface.p - entry.p).length() < kRadii[j] ? weight
                                                                                                 : 0);
    }
  }
  for (int k = 0; k < 3; ++k) {
    const Dipole d = channel(m, k);
    for (std::size_t j = 0; j < kRadii.size(); ++j)
      EXPECT_TRUE(mean_is(shares[std::size_t(k)][j], d.reflectance() * d.within(kRadii[j]), 0.12))
          << k << " " << kRadii[j];
  }
  // Of three channels of like probability.
  EXPECT_LT(largest, 3 * 2 * 0.8);
}

// Ten thousand coincident layers, open, with triangles of no area: probes end, and are finite.
TEST(Emergence, BearsAnyMesh) {
  Scene scene;
  const int material = add_material(scene, make_dense(0.99f, 1.3f));
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (std::uint32_t i = 0; i < 10000; ++i) {
    for (const Vec2f& p : {Vec2f(-4, -4), Vec2f(12, -4), Vec2f(-4, 12)})
      positions.push_back({p.x, -1e-4f * float(i), -p.y});
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    triangles.push_back({3 * i, 3 * i, 3 * i + 1});
  }
  Primitive layers;
  layers.positions = positions;
  layers.triangles = triangles;
  add_mesh(scene, layers, material);
  set_white_sky(scene);
  add_probe_above(scene, {0, 0, 0});
  EXPECT_GT(mean_of(diffused(scene, 4, Subsurface::dipole, 8), 0).value, 1) << "every layer gives light";
}

TEST(Diffusion, EndsAndStaysFiniteInExtremes) {
  for (const Subsurface method : {Subsurface::automatic, Subsurface::dipole, Subsurface::better_dipole,
                                  Subsurface::burley, Subsurface::photon_beam, Subsurface::off})
    for (const float scattering : {0.0f, 1e-6f, 1e9f})
      for (const float absorption : {0.0f, 1e-6f, 1e9f}) {
        Scene scene;
        add_shape(scene, make_sphere(1),
                  add_material(scene, make_dense(Rgb(absorption), Rgb(scattering), 1.3f)));
        set_white_sky(scene);
        add_probe(scene, {0, 0, 0}, {0, 0, 1}, 5, 1.5f);
        const Mean mean = mean_of(diffused(scene, 4, method, 8), 0);
        EXPECT_GT(mean.value, 0) << int(method) << " " << scattering << " " << absorption;
        EXPECT_LT(mean.value, 1.3) << int(method) << " " << scattering << " " << absorption;
      }
}

// A thick flat body: auto diffuses, and gives back what the walk would; off gives the same at once.
TEST(Automatic, OfABroadBodyIsDiffusionThatIsRight) {
  for (const Subsurface method : {Subsurface::automatic, Subsurface::off}) {
    Scene scene;
    add_block(scene, make_dense({0.5f, 0.1f, 0.01f}, {0.5f, 0.9f, 0.99f}, 1.3f), 1000);
    set_white_sky(scene);
    add_probe_above(scene, {0, 0, 0});
    RenderSettings settings = independent_settings(16, 16, 256);
    settings.layers.features = true;
    const Picture p = render(scene, settings, with(method));
    const std::array<double, 3> albedo{0.5, 0.9, 0.99};
    for (int k = 0; k < 3; ++k) {
      const double truth = seen(1.3, half_space_reflectance(albedo[std::size_t(k)], 1.3));
      EXPECT_TRUE(mean_is(mean_of(p, k), truth, 0.014 / truth)) << k;
    }
    EXPECT_EQ(p.at(8, 8)[channel_of(p, "sss.walk")], 0);
    EXPECT_GT(p.at(8, 8)[channel_of(p, "sss.diffusion")], 0.9f);
  }
}

// Behind glTF's diffuse transmission a thick body has about the colour that it asks for, walked or diffused.
TEST(Automatic, HasTheColourOfGltfsVolume) {
  std::array<std::array<Mean, 3>, 2> means;
  for (const Subsurface method : {Subsurface::automatic, Subsurface::random_walk}) {
    Scene scene;
    Material m;
    m.metallic = 0;
    m.diffuse_transmission =
        DiffuseTransmission{.factor = 1, .color = Rgb(1, 1, 1), .texture = {}, .color_texture = {}};
    m.volume = Volume{.thickness = 0, .attenuation_color = Rgb(0.5f), .attenuation_distance = 1};
    m.scatter = VolumeScatter{.multiscatter_color = {0.9f, 0.5f, 0.1f}, .anisotropy = 0};
    add_block(scene, m, 1000, 5000);
    set_white_sky(scene);
    add_probe_above(scene, {0, 0, 0});
    const Picture p = diffused(scene, 256, method);
    for (int k = 0; k < 3; ++k) means[method == Subsurface::random_walk][std::size_t(k)] = mean_of(p, k);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(means[0][k].value, means[1][k].value, 0.025) << k;
    EXPECT_NEAR(means[1][k].value, Rgb(0.9f, 0.5f, 0.1f)[int(k)], 0.04) << k;
  }
}

// The walk of auto leaves in other directions than that of random-walk, and no more often.
TEST(Automatic, OfASmallBodyAbsorbsAsTheWalkDoes) {
  std::array<Mean, 2> means;
  for (const Subsurface method : {Subsurface::automatic, Subsurface::random_walk}) {
    Scene scene;
    add_shape(scene, make_sphere(3), add_material(scene, make_dense(0.9f, 1.5f)));
    set_white_sky(scene);
    add_probe(scene, {0, 0, 0}, {0, 0, 1}, 5, 2.7f);
    means[method == Subsurface::random_walk] = mean_of(diffused(scene, 256, method), 0);
  }
  EXPECT_TRUE(means_agree(means[0], means[1], 0.025));
}

// A small body: auto walks, and loses nothing where nothing absorbs.
TEST(Automatic, OfASmallBodyIsTheWalk) {
  Scene scene;
  add_shape(scene, make_sphere(1), add_material(scene, make_dense(Rgb(1e-7f), Rgb(3), 1.3f)));
  set_white_sky(scene);
  add_probe(scene, {0, 0, 0}, {0, 0, 1}, 5, 0.9f);
  RenderSettings settings = independent_settings(16, 16, 64);
  settings.layers.features = true;
  const Picture p = render(scene, settings, with(Subsurface::automatic));
  EXPECT_TRUE(mean_is(mean_of(p, 0), 1, 0.01));
  EXPECT_EQ(p.at(8, 8)[channel_of(p, "sss.diffusion")], 0);
  EXPECT_GT(p.at(8, 8)[channel_of(p, "sss.walk")], 0.9f);
}

}  // namespace
}  // namespace parian
