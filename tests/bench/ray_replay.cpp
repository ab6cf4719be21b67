/// What the renderer costs on top of its rays: renders a scene on one thread, records every ray at the border
/// to Embree (the linker wraps rtcIntersect1 and rtcOccluded1), and replays the same rays bare in the same
/// order.
///
/// usage: ray_replay SCENE [SIZE] [SPP] [RUNS]
/// Prints CPU microseconds per camera path of both, and their ratio, run by run (interleaved) and as medians.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "integrators/integrators.h"
#include "renderer/accel/embree.h"
#include "renderer/base/parallel.h"
#include "renderer/session/session.h"
#include "scene_io/gltf.h"

namespace {

struct RecordedRay {
  float origin[3], direction[3], tfar;
  bool shadow;
};

RTCScene recorded_scene = nullptr;
std::vector<RecordedRay>* recorder = nullptr;

void record(RTCScene scene, const RTCRay& r, bool shadow) {
  if (!recorder) return;
  recorded_scene = scene;
  recorder->push_back({{r.org_x, r.org_y, r.org_z}, {r.dir_x, r.dir_y, r.dir_z}, r.tfar, shadow});
}

}  // namespace

extern "C" {
#if RTC_VERSION_MAJOR >= 4
void __real_rtcIntersect1(RTCScene, RTCRayHit*, RTCIntersectArguments*);
void __real_rtcOccluded1(RTCScene, RTCRay*, RTCOccludedArguments*);
void __wrap_rtcIntersect1(RTCScene scene, RTCRayHit* r, RTCIntersectArguments* a) {
  record(scene, r->ray, false);
  __real_rtcIntersect1(scene, r, a);
}
void __wrap_rtcOccluded1(RTCScene scene, RTCRay* r, RTCOccludedArguments* a) {
  record(scene, *r, true);
  __real_rtcOccluded1(scene, r, a);
}
#else
void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);
void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* c, RTCRayHit* r) {
  record(scene, r->ray, false);
  __real_rtcIntersect1(scene, c, r);
}
void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* c, RTCRay* r) {
  record(scene, *r, true);
  __real_rtcOccluded1(scene, c, r);
}
#endif
}

namespace {

using namespace parian;

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

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

/// Traces all rays; returns CPU seconds. Hits are counted so that nothing can be optimised away.
double replay(const std::vector<RecordedRay>& rays, std::size_t& hits) {
  const double start = cpu_seconds();
  for (const RecordedRay& r : rays) {
    EmbreeContext context;
    init_context(context);
    if (r.shadow) {
      RTCRay ray = to_ray(r);
      embree_occluded(recorded_scene, ray, context);
      hits += ray.tfar < 0;
    } else {
      RTCRayHit hit;
      hit.ray = to_ray(r);
      hit.hit.geomID = hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      embree_intersect(recorded_scene, hit, context, false);
      hits += hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
  }
  return cpu_seconds() - start;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
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
  auto scene = std::make_shared<Scene>(load_scene({argv[1]}, notes));
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
    const double start = cpu_seconds();
    session.start();
    session.wait();
    return cpu_seconds() - start;
  };
  std::vector<RecordedRay> rays;
  recorder = &rays;
  render();
  recorder = nullptr;

  const double paths = double(size) * size * spp;
  std::size_t hits = 0;
  std::vector<double> render_times, replay_times, ratios;
  for (int i = 0; i < runs; ++i) {
    render_times.push_back(render() / paths * 1e6);
    replay_times.push_back(replay(rays, hits) / paths * 1e6);
    ratios.push_back(render_times.back() / replay_times.back());
    fmt::print("run {}: render {:.3f} us, replay {:.3f} us, ratio {:.3f}\n", i + 1, render_times.back(),
               replay_times.back(), ratios.back());
  }
  fmt::print(
      "median: render {:.3f} us, replay {:.3f} us per camera path, ratio {:.3f}; {:.2f} rays per path, "
      "{:.1f}% hit\n",
      median(render_times), median(replay_times), median(ratios), double(rays.size()) / paths,
      100.0 * double(hits) / (double(rays.size()) * runs));
  return 0;
}
