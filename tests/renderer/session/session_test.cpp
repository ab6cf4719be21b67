// The session: one picture for any threads, tiles and interruptions; cancelling; time; what it counts.
#include "renderer/session/session.h"

#include <gtest/gtest.h>

#include "renderer/base/parallel.h"
#include "tests/integrators/support/shapes.h"
#include "tests/renderer/session/support/session_scenes.h"

namespace parian {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// Sets the number of threads for one test.
struct Threads {
  explicit Threads(int count) { set_thread_count(count); }
  ~Threads() { set_thread_count(hardware_threads()); }
};

// Caught: a sampler that goes on from pixel to pixel, sums in the order in which tiles end.
TEST(Session, ThePictureDoesNotDependOnThreadsOrTiles) {
  RenderSettings settings = small();
  const Picture reference = render_everything(settings);
  for (const int threads : {1, 2, 3}) {
    const Threads limit(threads);
    EXPECT_TRUE(same_bits(render_everything(settings), reference)) << threads << " threads";
  }
  for (const int size : {5, 64}) {
    settings.tiling.size = size;
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
    session.film().noise();
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
  settings.tiling.size = 64;
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

double seconds_to_render(Session& session) {
  const Clock::time_point start = Clock::now();
  session.start();
  session.wait();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Within 2%, though the 4 million pixels of one sample take some seconds. Caught: a limit looked at only
// between passes, which end minutes later, or between tiles of 256, half a second.
TEST(Session, TimeLimitEndsTheRender) {
  RenderSettings settings = small(kNoLimit);
  settings.seconds = 0.5;
  settings.width = settings.height = 2048;
  settings.tiling.size = 256;
  Session session = make_session(slow_room(), settings);
  double best = INFINITY;  // a busy machine delays threads, not all of them every time
  for (int i = 0; i < 15 && best > 0.51; ++i) {
    const double seconds = seconds_to_render(session);
    EXPECT_GE(seconds, 0.5);
    best = std::min(best, seconds);
  }
  EXPECT_LT(best, 0.51);
  EXPECT_FALSE(session.progress().running);
  EXPECT_EQ(session.progress().done, 1);
}

TEST(Session, TimeLimitKeepsWhatIsThereAndGoesOn) {
  RenderSettings settings = small(kNoLimit);
  settings.seconds = 0.2;
  Session session = make_session(everything(), settings);
  finish(session);
  const double before = session.film().mean_samples();
  EXPECT_GT(session.film().min_samples(), 0u);
  finish(session);
  EXPECT_GT(session.film().mean_samples(), before);
  // What was cut off in the middle of a pass is a beginning like any other.
  settings.seconds = 0;
  settings.spp = std::uint32_t(session.film().mean_samples()) + 50;
  Session rest = make_session(everything(), settings);
  rest.film().restore(session.film().save());
  EXPECT_TRUE(same_bits(finish(rest), render_everything(settings)));
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

}  // namespace
}  // namespace parian
