/// What the renderer costs on top of its rays: renders a scene on one thread, records every ray at the border
/// to Embree (the linker wraps its queries), and replays the same rays bare in the same order: each by
/// itself, as the shortest loop over rtcIntersect1 and rtcOccluded1 would trace them, and as they were
/// traced, in packets where the renderer made packets.
///
/// usage: ray_replay SCENE [SIZE] [SPP] [RUNS]
/// Prints CPU microseconds per camera path of the three, and the ratios, run by run (interleaved) and as
/// medians.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "integrators/integrators.h"
#include "renderer/accel/embree.h"
#include "renderer/base/parallel.h"
#include "renderer/session/session.h"
#include "scene_io/gltf/gltf.h"
#include "tests/bench/support/timing.h"

namespace {

constexpr int kPacket = 16;

struct RecordedRay {
  float origin[3], direction[3], tfar;
  bool shadow;
  std::uint8_t packet;  // of the first ray of a query: how many rays it had; 0: a query for this ray alone
};

RTCScene recorded_scene = nullptr;
std::vector<RecordedRay>* recorder = nullptr;

void record(RTCScene scene, const RTCRay& r, bool shadow) {
  if (!recorder) return;
  recorded_scene = scene;
  recorder->push_back({{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar, shadow, 0});
}

void record(RTCScene scene, const int* valid, const RTCRay16& r, bool shadow) {
  if (!recorder) return;
  recorded_scene = scene;
  const std::size_t first = recorder->size();
  for (int i = 0; i < kPacket; ++i)
    if (valid[i])
      recorder->push_back(
          {{r.org_x[i], r.org_y[i], r.org_z[i]}, {r.dir_x[i], r.dir_y[i], r.dir_z[i]}, r.tfar[i], shadow, 0});
  (*recorder)[first].packet = std::uint8_t(recorder->size() - first);
}

}  // namespace

// Embree 3 and 4 differ in what they are given besides scene and rays.
extern "C" {
#if RTC_VERSION_MAJOR >= 4
#define WRAP(FUNCTION, RAYS, ARGUMENTS, SHADOW, RAY)              \
  void __real_##FUNCTION(RTCScene, RAYS*, ARGUMENTS*);            \
  void __wrap_##FUNCTION(RTCScene scene, RAYS* r, ARGUMENTS* a) { \
    record(scene, RAY, SHADOW);                                   \
    __real_##FUNCTION(scene, r, a);                               \
  }
#define WRAP16(FUNCTION, RAYS, ARGUMENTS, SHADOW, RAY)                              \
  void __real_##FUNCTION(const int*, RTCScene, RAYS*, ARGUMENTS*);                  \
  void __wrap_##FUNCTION(const int* valid, RTCScene scene, RAYS* r, ARGUMENTS* a) { \
    record(scene, valid, RAY, SHADOW);                                              \
    __real_##FUNCTION(valid, scene, r, a);                                          \
  }
WRAP(rtcIntersect1, RTCRayHit, RTCIntersectArguments, false, r->ray)
WRAP(rtcOccluded1, RTCRay, RTCOccludedArguments, true, *r)
WRAP16(rtcIntersect16, RTCRayHit16, RTCIntersectArguments, false, r->ray)
WRAP16(rtcOccluded16, RTCRay16, RTCOccludedArguments, true, *r)
#else
#define WRAP(FUNCTION, RAYS, SHADOW, RAY)                                   \
  void __real_##FUNCTION(RTCScene, RTCIntersectContext*, RAYS*);            \
  void __wrap_##FUNCTION(RTCScene scene, RTCIntersectContext* c, RAYS* r) { \
    record(scene, RAY, SHADOW);                                             \
    __real_##FUNCTION(scene, c, r);                                         \
  }
#define WRAP16(FUNCTION, RAYS, SHADOW, RAY)                                                   \
  void __real_##FUNCTION(const int*, RTCScene, RTCIntersectContext*, RAYS*);                  \
  void __wrap_##FUNCTION(const int* valid, RTCScene scene, RTCIntersectContext* c, RAYS* r) { \
    record(scene, valid, RAY, SHADOW);                                                        \
    __real_##FUNCTION(valid, scene, c, r);                                                    \
  }
WRAP(rtcIntersect1, RTCRayHit, false, r->ray)
WRAP(rtcOccluded1, RTCRay, true, *r)
WRAP16(rtcIntersect16, RTCRayHit16, false, r->ray)
WRAP16(rtcOccluded16, RTCRay16, true, *r)
#endif
}

namespace {

using namespace parian;

RTCRay to_ray(const RecordedRay& r) {
  RTCRay ray;
  ray.org_x = r.origin[0];
  ray.org_y = r.origin[1];
  ray.org_z = r.origin[2];
  ray.dir_x = r.direction[0];
  ray.dir_y = r.direction[1];
  ray.dir_z = r.direction[2];
  ray.tnear = 0;
  ray.tfar = r.tfar;
  ray.time = 0;
  ray.mask = 0xffffffffu;
  ray.id = ray.flags = 0;
  return ray;
}

void trace_alone(const RecordedRay& r, std::size_t& hits) {
  EmbreeContext context;
  init_context(context, false);
  if (r.shadow) {
    RTCRay ray = to_ray(r);
    embree_occluded(recorded_scene, ray, context);
    hits += ray.tfar < 0;
  } else {
    RTCRayHit hit;
    hit.ray = to_ray(r);
    hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    embree_intersect(recorded_scene, hit, context);
    hits += hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
  }
}

/// Traces all rays, each by itself; returns CPU seconds. Hits are counted so that nothing can be optimised
/// away.
double replay_alone(const std::vector<RecordedRay>& rays, std::size_t& hits) {
  const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
  for (const RecordedRay& r : rays) trace_alone(r, hits);
  return seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
}

void set_lane(RTCRay16& ray, int i, const RecordedRay& r) {
  ray.org_x[i] = r.origin[0];
  ray.org_y[i] = r.origin[1];
  ray.org_z[i] = r.origin[2];
  ray.dir_x[i] = r.direction[0];
  ray.dir_y[i] = r.direction[1];
  ray.dir_z[i] = r.direction[2];
  ray.tnear[i] = 0;
  ray.tfar[i] = r.tfar;
  ray.time[i] = 0;
  ray.mask[i] = 0xffffffffu;
  ray.id[i] = ray.flags[i] = 0;
}

/// Traces all rays in the queries that the renderer made; returns CPU seconds.
double replay_as_traced(const std::vector<RecordedRay>& rays, std::size_t& hits) {
  const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
  for (std::size_t next = 0; next < rays.size();) {
    const RecordedRay* r = &rays[next];
    if (r->packet == 0) {
      trace_alone(*r, hits);
      ++next;
      continue;
    }
    EmbreeContext context;
    init_context(context, !r->shadow);
    alignas(64) int valid[kPacket];
    RTCRayHit16 packet;
    for (int i = 0; i < kPacket; ++i) {
      valid[i] = i < r->packet ? -1 : 0;
      set_lane(packet.ray, i, r[std::min(i, r->packet - 1)]);
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (r->shadow) {
      embree_occluded(recorded_scene, valid, packet.ray, context);
      for (int i = 0; i < r->packet; ++i) hits += packet.ray.tfar[i] < 0;
    } else {
      embree_intersect(recorded_scene, valid, packet, context);
      for (int i = 0; i < r->packet; ++i) hits += packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
    }
    next += r->packet;
  }
  return seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: {} SCENE [SIZE] [SPP] [RUNS]\n", argv[0]);
    return 2;
  }
  const int size = argc > 2 ? std::atoi(argv[2]) : 512, spp = argc > 3 ? std::atoi(argv[3]) : 4,
            runs = argc > 4 ? std::atoi(argv[4]) : 7;
  set_thread_count(1);
  std::vector<std::string> notes;
  auto scene = std::make_shared<Scene>(load_scene({argv[1]}, {}, notes));
  add_missing_camera_and_light(*scene);
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.spp = std::uint32_t(spp);
  settings.layers = {false, false, false};
  IntegratorSettings path;
  path.max_depth = 12;
  Session session(scene, settings, make_integrator("path", path));

  const auto render = [&] {
    session.film().clear();
    const double start = seconds(CLOCK_PROCESS_CPUTIME_ID);
    session.start();
    session.wait();
    return seconds(CLOCK_PROCESS_CPUTIME_ID) - start;
  };
  std::vector<RecordedRay> rays;
  recorder = &rays;
  render();
  recorder = nullptr;

  const double paths = double(size) * size * spp;
  std::size_t hits = 0;
  std::vector<double> times[3], ratios[2];
  for (int i = 0; i < runs; ++i) {
    times[0].push_back(render() / paths * 1e6);
    times[1].push_back(replay_alone(rays, hits) / paths * 1e6);
    times[2].push_back(replay_as_traced(rays, hits) / paths * 1e6);
    for (int k = 0; k < 2; ++k) ratios[k].push_back(times[0].back() / times[k + 1].back());
    fmt::print("run {}: render {:.3f} us, replay {:.3f} us, as traced {:.3f} us, ratios {:.3f} {:.3f}\n",
               i + 1, times[0].back(), times[1].back(), times[2].back(), ratios[0].back(), ratios[1].back());
  }
  fmt::print(
      "median: render {:.3f} us, replay {:.3f} us, as traced {:.3f} us per camera path, ratios {:.3f} "
      "{:.3f}; "
      "{:.2f} rays per path, {:.1f}% hit\n",
      median(times[0]), median(times[1]), median(times[2]), median(ratios[0]), median(ratios[1]),
      double(rays.size()) / paths, 100.0 * double(hits) / (double(rays.size()) * 2 * runs));
  return 0;
}
