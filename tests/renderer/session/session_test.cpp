// The session: one picture for any threads, tiles, interruptions and edits; cancelling; time; what it counts.
#include "renderer/session/session.h"

#include <gtest/gtest.h>

#include <functional>

#include "integrators/integrators.h"
#include "renderer/base/parallel.h"
#include "tests/integrators/support/shapes.h"

namespace parian {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Something of everything: a textured floor, boxes drawn once and twice, a blended pane, lights of all
/// kinds, a lens, solids that emit, reflect and blend, a box without a mesh.
Scene everything() {
  Scene scene;
  Material checks = make_lambert({0.8f, 0.8f, 0.8f});
  checks.base_color_texture = add_texture(
      scene, make_image(2, 2, 3, PixelType::u8,
                        std::vector<std::uint8_t>{255, 255, 255, 90, 40, 20, 60, 90, 160, 255, 255, 255}));
  Material pane = make_lambert({0.2f, 0.9f, 0.3f});
  pane.alpha_mode = AlphaMode::blend;
  pane.alpha = 0.5f;
  add_mesh(scene, make_quad({0, 0, 0}, {3, 0, 0}, {0, 0, -3}), add_material(scene, checks));  // 0
  add_mesh(scene, make_box({0, 0, 0}, {0.6f, 0.6f, 0.6f}), add_material(scene, Material{}),
           translate({-1, 0, -0.5f}));  // 1
  Node second = scene.nodes[1];
  second.transform = translate({0.5f, 0.1f, -1});
  second.transform.rotation = Quatf(0.9f, 0, 0.4f, 0).normalized();
  add_root(scene, second);                                                                             // 2
  add_mesh(scene, make_quad({0, 0.6f, 0.3f}, {0.5f, 0, 0}, {0, 0.5f, 0}), add_material(scene, pane));  // 3
  add_mesh(scene, make_uv_sphere({0, 0, 0}, 0.2f, 8), add_material(scene, make_emitter({3, 2, 1})),
           translate({1.2f, 0.8f, 0}));  // 4
  add_light(scene, make_area_light(LightKind::disk, 6, 0.8f),
            look_along({-1, 2, 1}, normalize(Vec3f(0.5f, -1, -0.5f))));  // 5
  Light point;
  point.intensity = 2;
  add_light(scene, point, translate({0, 1.5f, 1}));  // 6
  scene.environment.radiance = Rgb(0.1f, 0.15f, 0.3f);
  Camera camera;
  camera.yfov = 0.7f;
  camera.lens = Lens{};
  camera.lens->focus_distance = 4;
  add_camera(scene, camera, look_along({1, 1.5f, 4}, normalize(Vec3f(-0.25f, -0.3f, -1))));  // 7
  add_shape(scene, make_sphere(0.25f), add_material(scene, make_emitter({1, 3, 2})),
            translate({0.2f, 0.4f, 0.9f}));                                                       // 8
  add_shape(scene, make_cylinder(0.3f, 0.1f, 0.6f), 1, translate({-0.6f, 0.3f, 0.9f}));           // 9
  add_shape(scene, make_flat_shape(ShapeKind::box, Vec3f(0.3f)), 1, translate({1, 0.2f, 0.6f}));  // 10
  add_shape(scene, make_sphere(0.2f), 2, translate({-0.2f, 0.9f, 0.6f}));                         // 11
  return scene;
}

RenderSettings small(std::uint32_t spp = 7) {
  RenderSettings s;
  s.width = 53;
  s.height = 37;
  s.spp = spp;
  s.seed = 5;
  s.layers = {true, true, true};
  return s;
}

Session make_session(const Scene& scene, const RenderSettings& settings) {
  validate(scene, "test scene");
  return Session(std::make_shared<const Scene>(scene), settings, make_integrator("path", {}));
}

Picture finish(Session& session) {
  session.start();
  session.wait();
  return session.snapshot();
}

Picture render_everything(const RenderSettings& settings) {
  Session session = make_session(everything(), settings);
  return finish(session);
}

testing::AssertionResult same_bits(const Picture& a, const Picture& b) {
  if (a.channels != b.channels || a.pixels.size() != b.pixels.size())
    return testing::AssertionFailure() << "other layers";
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    differ += std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(float)) != 0;
  if (!differ) return testing::AssertionSuccess();
  return testing::AssertionFailure() << differ << " of " << a.pixels.size() << " values differ";
}

/// Sets the number of threads for one test.
struct Threads {
  explicit Threads(int count) { set_thread_count(count); }
  ~Threads() { set_thread_count(hardware_threads()); }
};

// GT 56. Caught: a sampler that goes on from pixel to pixel, sums in the order in which tiles end.
TEST(Session, ThePictureDoesNotDependOnThreadsOrTiles) {
  RenderSettings settings = small();
  const Picture reference = render_everything(settings);
  for (const int threads : {1, 2, 3}) {
    const Threads limit(threads);
    EXPECT_TRUE(same_bits(render_everything(settings), reference)) << threads << " threads";
  }
  for (const int size : {5, 64}) {
    settings.tile_size = size;
    EXPECT_TRUE(same_bits(render_everything(settings), reference)) << "tiles of " << size;
  }
  settings = small();
  ++settings.seed;
  EXPECT_FALSE(same_bits(render_everything(settings), reference));
}

// Caught: samples numbered anew after an interruption, or by what this run has drawn.
TEST(Session, ThePictureDoesNotDependOnInterruptions) {
  const RenderSettings settings = small(40);
  const Picture reference = render_everything(settings);
  Session session = make_session(everything(), settings);
  int interruptions = 0;
  for (int i = 0; i < 30 && session.film().min_samples() < settings.spp; ++i) {
    session.start();
    std::this_thread::sleep_for(milliseconds(1 + 3 * (i % 5)));
    session.cancel();
    interruptions += session.film().min_samples() < settings.spp;
  }
  EXPECT_TRUE(same_bits(finish(session), reference));
  EXPECT_GT(interruptions, 0);
}

TEST(Session, ThePictureDoesNotDependOnSaveAndRestore) {
  RenderSettings settings = small(12);
  const Picture reference = render_everything(settings);
  settings.spp = 5;
  Session first = make_session(everything(), settings);
  finish(first);
  settings.spp = 12;
  Session second = make_session(everything(), settings);
  second.film().restore(first.film().save());
  EXPECT_TRUE(same_bits(finish(second), reference));
  EXPECT_EQ(second.stats().rays.camera, std::uint64_t(53 * 37 * 7));
}

// Passes of other lengths: 64 samples at once are those of 16 and 48 more.
TEST(Session, MoreSamplesGoOnFromFewer) {
  RenderSettings settings = small(3);
  Session session = make_session(everything(), settings);
  finish(session);
  const std::vector<char> early = session.film().save();
  settings.spp = 3;
  Session again = make_session(everything(), settings);
  again.film().restore(early);
  EXPECT_TRUE(same_bits(finish(again), session.snapshot()));  // nothing left to do
  EXPECT_EQ(again.stats().rays.camera, 0u);
}

TEST(Session, SnapshotsWhileRenderingAreHarmless) {
  const RenderSettings settings = small(60);
  const Picture reference = render_everything(settings);
  Session session = make_session(everything(), settings);
  session.start();
  int looks = 0;
  while (session.progress().running) {
    const Picture p = session.snapshot();
    for (const float c : p.pixels) ASSERT_TRUE(std::isfinite(c));
    session.film().relative_noise();
    session.stats();
    ++looks;
  }
  session.wait();
  EXPECT_GT(looks, 1);
  EXPECT_TRUE(same_bits(session.snapshot(), reference));
}

TEST(Session, ProgressGrowsToTheEnd) {
  Session session = make_session(everything(), small(30));
  EXPECT_EQ(session.progress().samples, 0u);
  EXPECT_FALSE(session.progress().running);
  session.start();
  std::uint32_t last = 0;
  while (session.progress().running) {
    const Progress p = session.progress();
    ASSERT_GE(p.samples, last);
    ASSERT_EQ(p.total, 30u);
    last = p.samples;
  }
  session.wait();
  EXPECT_EQ(session.progress().samples, 30u);
  const SessionStats stats = session.stats();
  EXPECT_EQ(stats.rays.camera, std::uint64_t(53 * 37 * 30));
  EXPECT_GT(stats.rays.shadow, 0u);
  EXPECT_GT(stats.rays.scattered, 0u);
  EXPECT_EQ(stats.rays.dropped, 0u);
  EXPECT_GT(stats.render_seconds, 0);
  EXPECT_EQ(stats.triangles, 2u + 12 + 2 + 2 * 8 * 14 + 12);
}

/// A white room that light leaves slowly: long paths, large pictures.
Scene slow_room() {
  Scene scene;
  Material m = make_lambert({0.99f, 0.99f, 0.99f});
  m.emission = {1, 1, 1};
  add_mesh(scene, turned(make_uv_sphere({0, 0, 0}, 1, 64)), add_material(scene, m));
  add_camera(scene, Camera{});
  return scene;
}

// Caught: cancelling only between passes, which here last seconds, or between tiles, which last a fifth of
// one.
TEST(Session, CancelIsQuick) {
  RenderSettings settings = small(100000);
  settings.width = settings.height = 512;
  settings.tile_size = 64;
  Session session = make_session(slow_room(), settings);
  std::vector<double> latencies;
  for (int i = 0; i < 7; ++i) {
    session.start();
    std::this_thread::sleep_for(milliseconds(100 + 37 * i));
    const Clock::time_point start = Clock::now();
    session.cancel();
    latencies.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    EXPECT_FALSE(session.progress().running);
  }
  std::ranges::sort(latencies);
  // 50 milliseconds on a quiet machine; a busy one delays threads, not all of them every time.
  EXPECT_LT(latencies[0], 0.05);
  EXPECT_LT(latencies[3], 0.2);
}

TEST(Session, CancelWithoutStartAndTwiceIsHarmless) {
  Session session = make_session(everything(), small());
  session.cancel();
  session.start();
  session.cancel();
  session.cancel();
  session.wait();
  session.start();
  session.start();  // starts over what runs
  session.wait();
  EXPECT_TRUE(same_bits(session.snapshot(), render_everything(small())));
}

// Caught: a limit looked at only between passes, or not at all.
TEST(Session, TimeLimitEndsTheRender) {
  RenderSettings settings = small();
  settings.seconds = 0.4;
  Session session = make_session(everything(), settings);
  const Clock::time_point start = Clock::now();
  session.start();
  session.wait();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  EXPECT_GE(seconds, 0.4);
  EXPECT_LT(seconds, 3);
  EXPECT_GT(session.film().min_samples(), 0u);
  EXPECT_FALSE(session.progress().running);
  // And goes on for as long again.
  const std::uint64_t rays = session.stats().rays.camera;
  session.start();
  session.wait();
  EXPECT_GT(session.stats().rays.camera, rays);

  // In the middle of a pass that takes many seconds.
  settings.width = settings.height = 1024;
  Session slow = make_session(slow_room(), settings);
  const Clock::time_point slow_start = Clock::now();
  slow.start();
  slow.wait();
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - slow_start).count(), 3);
}

/// Gives each sample of a pixel another kind of number.
class BrokenIntegrator final : public Integrator {
 public:
  void estimate(const TraceContext&, std::span<CameraPath> paths, RayCounts&, bool) const override {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const Rgb kinds[5] = {{kNan, 1, 1}, {1, kInfinity, 1}, {1, 1, -1e-3f}, {1, 1, -kInfinity}, {5, 5, 5}};
    for (CameraPath& path : paths) path.radiance = kinds[int(path.sampler.next1() * 5)];
  }
};

// Caught: a check of red alone; infinity or negative numbers let through; dropped samples not counted as
// black, so that the mean of the others is too bright.
TEST(Session, DropsWhatIsNotARadianceAndCountsIt) {
  RenderSettings settings = small(100);
  settings.sampler = SamplerKind::independent;
  Session session(std::make_shared<const Scene>(everything()), settings,
                  std::make_unique<BrokenIntegrator>());
  session.start();
  session.wait();
  const Picture p = session.snapshot();
  double sum = 0;
  for (int y = 0; y < p.height; ++y)
    for (int x = 0; x < p.width; ++x) {
      for (std::size_t c = 0; c < p.channels.size(); ++c) ASSERT_TRUE(std::isfinite(p.at(x, y)[c]));
      sum += p.at(x, y)[2];
    }
  EXPECT_NEAR(sum / (p.width * p.height), 1, 0.03);
  const SessionStats stats = session.stats();
  EXPECT_NEAR(double(stats.rays.dropped) / double(stats.rays.camera), 0.8, 0.01);
}

class ThrowingIntegrator final : public Integrator {
 public:
  void estimate(const TraceContext&, std::span<CameraPath>, RayCounts&, bool) const override {
    throw std::runtime_error("no radiance");
  }
};

TEST(Session, WaitRethrowsWhatStoppedTheRender) {
  Session session(std::make_shared<const Scene>(everything()), small(),
                  std::make_unique<ThrowingIntegrator>());
  session.start();
  EXPECT_THROW(session.wait(), std::runtime_error);
  EXPECT_FALSE(session.progress().running);
  session.wait();
}

// The variance layer against the variance between seeds. Caught: sums divided by n once too often or too
// rarely, n for n - 1 (12% at 8 samples).
TEST(Session, VarianceLayerPredictsTheVarianceBetweenSeeds) {
  constexpr int kSeeds = 40, kSize = 32;
  RenderSettings settings;
  settings.width = settings.height = kSize;
  settings.spp = 8;
  settings.sampler = SamplerKind::independent;
  settings.filter = FilterKind::box;
  std::vector<double> sum(kSize * kSize, 0), squares(sum);
  double predicted = 0, measured = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.seed = std::uint32_t(seed);
    // No lamp that a path finds by chance alone: one such sample would be all of the variance.
    Scene scene = everything();
    scene.roots.erase(scene.roots.begin() + 4);
    Session session = make_session(scene, settings);
    const Picture p = finish(session);
    ASSERT_EQ(p.channels[4], "variance.G");
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double c = p.pixels[i * p.channels.size() + 1];
      sum[i] += c;
      squares[i] += c * c;
      predicted += p.pixels[i * p.channels.size() + 4];
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i)
    measured += (squares[i] - sum[i] * sum[i] / kSeeds) / (kSeeds - 1);
  EXPECT_NEAR(predicted / kSeeds / measured, 1, 0.05);
}

struct Edit {
  const char* name;
  unsigned changed;
  std::function<void(Scene&)> apply;
  // What an editable and a plain session may rebuild.
  bool mesh_builds_plain, mesh_builds_editable, top_builds, light_builds;
};

std::vector<Edit> edits() {
  return {
      {"camera moved", kChangedCamera,
       [](Scene& s) {
         s.nodes[7].transform = look_along({-1, 1, 4}, normalize(Vec3f(0.2f, -0.2f, -1)));
       },
       false, false, false, false},
      {"camera changed", kChangedCamera,
       [](Scene& s) { s.cameras[0].yfov = 0.4f, s.cameras[0].lens.reset(); }, false, false, false, false},
      {"colour", kChangedMaterials,
       [](Scene& s) {
         s.materials[1].base_color = {0.9f, 0.1f, 0.1f}, s.materials[1].metallic = 0;
       },
       false, false, false, true},
      {"emission", kChangedMaterials,
       [](Scene& s) {
         s.materials[3].emission = {0, 5, 9}, s.materials[1].emission = {0.2f, 0, 0};
       },
       false, false, false, true},
      {"texture", kChangedMaterials, [](Scene& s) { s.materials[0].base_color_texture = {}; }, false, false,
       false, true},
      {"coverage", kChangedMaterials, [](Scene& s) { s.materials[2].alpha = 0.2f; }, false, false, false,
       true},
      {"opaque to blended", kChangedMaterials,
       [](Scene& s) { s.materials[1].alpha_mode = AlphaMode::blend, s.materials[1].alpha = 0.5f; }, true,
       true, true, true},
      {"brighter lights", kChangedLights,
       [](Scene& s) {
         s.lights[0].intensity = 20, s.lights[1].intensity = 0.1f, s.environment.radiance = Rgb(1, 0, 0);
       },
       false, false, true, true},
      {"light added", kChangedLights | kChangedTransforms,
       [](Scene& s) {
         add_light(s, make_area_light(LightKind::rectangle, 4, 1, 1), look_along({0, 2, -2}, {0, 0, 1}));
       },
       true, true, true, true},
      {"light removed", kChangedLights, [](Scene& s) { s.nodes[5].light = kNone; }, true, true, true, true},
      {"environment image", kChangedLights,
       [](Scene& s) {
         s.environment.image = int(s.images.size());
         s.images.push_back(make_image(4, 2, 1, PixelType::f32, std::vector<float>{1, 5, 2, 0, 0, 1, 3, 1}));
       },
       false, false, true, true},
      {"disk moved", kChangedTransforms,
       [](Scene& s) {
         s.nodes[5].transform = look_along({1, 2, 1}, normalize(Vec3f(-0.5f, -1, -0.5f)));
       },
       false, false, true, true},
      {"boxes moved", kChangedTransforms,
       [](Scene& s) {
         s.nodes[1].transform = translate({0, 0.5f, 0}), s.nodes[2].transform.scale = {1, 2, 1};
       },
       false, false, true, true},
      {"floor and emitter moved", kChangedTransforms,
       [](Scene& s) {
         s.nodes[0].transform = translate({0, 0.2f, 0}), s.nodes[4].transform = translate({-1, 1, 0});
       },
       true, false, true, true},
      {"solids moved", kChangedTransforms,
       [](Scene& s) {
         s.nodes[8].transform = translate({0.5f, 0.6f, 0.9f}), s.nodes[9].transform.scale = {1, 1, 2};
         s.nodes[11].transform = translate({-0.3f, 0.8f, 0.5f});
       },
       false, false, true, true},
      {"sphere squeezed", kChangedTransforms,
       [](Scene& s) {
         s.nodes[8].transform.scale = {1, 2, 1};
       },
       true, true, true, true},
      {"solid reshaped", kChangedGeometry,
       [](Scene& s) { s.shapes[0].radius = 0.4f, s.shapes[1].radius_top = 0, s.shapes[2].size.y = 0.6f; },
       true, true, true, true},
      {"mesh hidden", kChangedTransforms,
       [](Scene& s) {
         s.nodes[1].transform.scale = {0, 0, 0};
       },
       true, true, true, true},
      {"mesh added", kChangedGeometry,
       [](Scene& s) {
         add_mesh(s, make_box({1, 0, 1}, {1.5f, 0.5f, 1.5f}), 1);
       },
       true, true, true, true},
      {"mesh reshaped", kChangedGeometry,
       [](Scene& s) {
         const int material = s.meshes[1].primitives[0].material;
         s.meshes[1].primitives[0] = make_uv_sphere({0, 0.3f, 0}, 0.5f, 6);
         s.meshes[1].primitives[0].material = material;
       },
       true, true, true, true},
      {"all at once",
       kChangedCamera | kChangedMaterials | kChangedLights | kChangedTransforms | kChangedGeometry,
       [](Scene& s) {
         s = everything(), s.nodes[1].transform = {}, s.materials[1].metallic = 0, s.lights[1].intensity = 9;
       },
       true, true, true, true},
  };
}

// Each edit gives the picture of a session that never knew another scene, to the bit, and rebuilds no more
// than it must. Caught: lights or a camera left as they were, a film not cleared, vertices not moved, a BVH
// built for a colour.
TEST(Session, EditsMatchFreshSessions) {
  for (const bool editable : {false, true})
    for (const Edit& edit : edits()) {
      RenderSettings settings = small(4);
      settings.accel.editable = editable;
      Scene edited = everything();
      edit.apply(edited);
      Session session = make_session(everything(), settings);
      finish(session);
      const SessionStats before = session.stats();
      validate(edited, edit.name);
      session.update(std::make_shared<const Scene>(edited), edit.changed);
      EXPECT_EQ(session.progress().samples, 0u);
      const Picture after = finish(session);
      Session fresh = make_session(edited, settings);
      const Picture expected = finish(fresh);
      EXPECT_TRUE(same_bits(after, expected)) << edit.name << (editable ? ", editable" : "");
      EXPECT_FALSE(same_bits(after, render_everything(settings))) << edit.name;

      const SessionStats stats = session.stats();
      const bool meshes = editable ? edit.mesh_builds_editable : edit.mesh_builds_plain;
      // A new Accel counts from nothing.
      const bool rebuilt = meshes && edit.top_builds && stats.builds.top_level == 1;
      EXPECT_EQ(rebuilt || stats.builds.meshes > before.builds.meshes, meshes)
          << edit.name << (editable ? ", editable" : "");
      EXPECT_EQ(rebuilt || stats.builds.top_level > before.builds.top_level, edit.top_builds) << edit.name;
      EXPECT_EQ(stats.light_builds > before.light_builds, edit.light_builds) << edit.name;
    }
}

// One after the other in one session.
TEST(Session, EditsAddUp) {
  RenderSettings settings = small(3);
  settings.accel.editable = true;
  Session session = make_session(everything(), settings);
  Scene scene = everything();
  for (const Edit& edit : edits()) {
    if (edit.changed & kChangedGeometry) continue;
    edit.apply(scene);
    session.update(std::make_shared<const Scene>(scene), edit.changed);
  }
  Session fresh = make_session(scene, settings);
  EXPECT_TRUE(same_bits(finish(session), finish(fresh)));
}

TEST(Session, EditsWhileRenderingGoOnRendering) {
  RenderSettings settings = small(30);
  Session session = make_session(everything(), settings);
  session.start();
  Scene scene = everything();
  for (int i = 0; i < 6; ++i) {
    std::this_thread::sleep_for(milliseconds(5));
    scene.nodes[1].transform = translate({-1, 0.1f * float(i), 0});
    scene.nodes[7].transform =
        look_along({1, 1.5f + 0.1f * float(i), 4}, normalize(Vec3f(-0.25f, -0.3f, -1)));
    session.start();
    session.update(std::make_shared<const Scene>(scene), kChangedTransforms | kChangedCamera);
    EXPECT_TRUE(session.progress().running || session.progress().samples == 30);
  }
  session.wait();
  Session fresh = make_session(scene, settings);
  EXPECT_TRUE(same_bits(session.snapshot(), finish(fresh)));
}

}  // namespace
}  // namespace parian
