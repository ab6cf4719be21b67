/// What a million spheres cost against a million triangles and a million instances of a unit sphere: build
/// time on all threads, memory, rays per second of one thread.
///
/// usage: million_shapes [COUNT]
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/accel/embree.h"
#include "renderer/base/parallel.h"
#include "renderer/base/random.h"
#include "renderer/base/sampling.h"
#include "tests/bench/support/timing.h"
#include "tests/support/scenes.h"

namespace {

using namespace parian;

/// Resident memory of the process, which counts what Embree does not report.
double resident_bytes() {
  double pages = 0;
  std::ifstream("/proc/self/statm") >> pages >> pages;
  return pages * double(sysconf(_SC_PAGESIZE));
}

class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : sampler_(SamplerKind::independent, seed, 0, 0, 0) {}
  Vec2f next2() { return sampler_.next2(); }
  Vec3f in_cube() {
    const Vec2f xy = next2();
    return {xy.x, xy.y, next2().x};
  }

 private:
  Sampler sampler_;
};

/// From anywhere in the cube to anywhere.
std::vector<Ray> random_rays(int count) {
  Numbers numbers(2);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3f o = numbers.in_cube();
    rays.push_back({o, sample_sphere(numbers.next2())});
  }
  return rays;
}

std::vector<Vec3f> random_centers(std::size_t count) {
  Numbers numbers(1);
  std::vector<Vec3f> centers(count);
  for (Vec3f& center : centers) center = numbers.in_cube();
  return centers;
}

Scene sphere_scene(const std::vector<Vec3f>& centers, float radius) {
  Scene scene;
  scene.shapes = {make_sphere(radius)};
  scene.materials.emplace_back();
  Node node;
  node.shape = node.shape_material = 0;
  std::vector<InstanceTransform> places(centers.size());
  for (std::size_t i = 0; i < centers.size(); ++i) places[i].translation = centers[i];
  node.instances = std::move(places);
  add_root(scene, std::move(node));
  return scene;
}

/// Equilateral triangles of that circumradius, turned at random.
Scene triangle_scene(const std::vector<Vec3f>& centers, float circumradius) {
  Numbers numbers(3);
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  positions.reserve(3 * centers.size());
  triangles.reserve(centers.size());
  for (const Vec3f& center : centers) {
    const Frame frame = make_frame(sample_sphere(numbers.next2()));
    const float turn = numbers.next2().x;
    const auto first = std::uint32_t(positions.size());
    for (int k = 0; k < 3; ++k) {
      const float angle = (turn + float(k) / 3) * 2 * kPi;
      positions.push_back(center + frame.to_world({std::cos(angle), std::sin(angle), 0}) * circumradius);
    }
    triangles.push_back({first, first + 1, first + 2});
  }
  Primitive primitive;
  primitive.positions = std::move(positions);
  primitive.triangles = std::move(triangles);
  Scene scene;
  scene.materials.emplace_back();
  add_mesh(scene, std::move(primitive), 0);
  return scene;
}

/// A unit sphere as user geometry in a scene of its own, instanced for each centre: what a renderer would do
/// that has one way to place things.
class InstancedSpheres {
 public:
  InstancedSpheres() = default;
  InstancedSpheres(const InstancedSpheres&) = delete;
  InstancedSpheres& operator=(const InstancedSpheres&) = delete;
  ~InstancedSpheres() { release(); }

  void build(const std::vector<Vec3f>& centers, float radius) {
    release();
    const double start = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    device_ = rtcNewDevice(fmt::format("threads={}", thread_count()).c_str());
    rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes);
    unit_ = new_scene();
    RTCGeometry sphere = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(sphere, 1);
    rtcSetGeometryBoundsFunction(sphere, bound_unit, nullptr);
    rtcSetGeometryIntersectFunction(sphere, intersect_unit);
    attach(unit_, sphere);
    rtcCommitScene(unit_);
    top_ = new_scene();
    for (const Vec3f& center : centers) {
      RTCGeometry instance = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(instance, unit_);
      const Affine map{{radius, 0, 0}, {0, radius, 0}, {0, 0, radius}, center};
      rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, &map);
      attach(top_, instance);
    }
    rtcCommitScene(top_);
    wall_seconds = seconds(CLOCK_MONOTONIC) - start;
    cpu_seconds = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
  }

  std::size_t trace(const std::vector<Ray>& rays) const {
    std::size_t hits = 0;
    for (const Ray& ray : rays) {
      EmbreeContext context;
      init_context(context, false);
      RTCRayHit r;
      r.ray = {ray.o.x, ray.o.y, ray.o.z, 0, ray.d.x, ray.d.y, ray.d.z, 0, ray.tmax, 0xffffffffu, 0, 0};
      r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      embree_intersect(top_, r, context);
      hits += r.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return hits;
  }

  double wall_seconds = 0, cpu_seconds = 0;
  std::atomic<std::ptrdiff_t> bytes{0};

 private:
  static bool count_bytes(void* user, ssize_t count, bool) {
    static_cast<std::atomic<std::ptrdiff_t>*>(user)->fetch_add(count);
    return true;
  }
  static void bound_unit(const RTCBoundsFunctionArguments* a) { *a->bounds_o = {-1, -1, -1, 0, 1, 1, 1, 0}; }
  static void intersect_unit(const RTCIntersectFunctionNArguments* a) {
    RTCRayN* rays = RTCRayHitN_RayN(a->rayhit, a->N);
    RTCHitN* hits = RTCRayHitN_HitN(a->rayhit, a->N);
    for (unsigned i = 0; i < a->N; ++i) {
      if (a->valid[i] != -1) continue;
      const Vec3d o(RTCRayN_org_x(rays, a->N, i), RTCRayN_org_y(rays, a->N, i), RTCRayN_org_z(rays, a->N, i));
      const Vec3d d(RTCRayN_dir_x(rays, a->N, i), RTCRayN_dir_y(rays, a->N, i), RTCRayN_dir_z(rays, a->N, i));
      const std::optional<Chord> chord = intersect(Sphere{1}, o, d);
      if (!chord) continue;
      const double t = chord->enter.t > 0 ? chord->enter.t : chord->leave.t;
      if (!(t > 0 && t < RTCRayN_tfar(rays, a->N, i))) continue;
      RTCRayN_tfar(rays, a->N, i) = float(t);
      RTCHitN_primID(hits, a->N, i) = a->primID;
      RTCHitN_geomID(hits, a->N, i) = a->geomID;
      RTCHitN_instID(hits, a->N, i, 0) = a->context->instID[0];
    }
  }

  RTCScene new_scene() const {
    RTCScene scene = rtcNewScene(device_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    return scene;
  }
  static void attach(RTCScene scene, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  void release() {
    if (!device_) return;
    rtcReleaseScene(top_);
    rtcReleaseScene(unit_);
    rtcReleaseDevice(device_);
    bytes = 0;
  }

  RTCDevice device_ = nullptr;
  RTCScene unit_ = nullptr, top_ = nullptr;
};

struct Contender {
  std::string name;
  std::function<std::array<double, 3>()> build;  // wall seconds of world and BVH, CPU seconds
  std::function<std::size_t()> trace, bytes;
  std::vector<double> world, accel, cpu, rates;
  std::size_t hits = 0;
  double resident = 0;  // what the first build added
};

Contender make_contender(std::string name, Scene scene, const std::vector<Ray>& rays) {
  auto built = std::make_shared<TimedBuild>();
  built->scene = std::move(scene);
  const auto trace = [built, &rays] {
    std::size_t hits = 0;
    Hit hit;
    for (const Ray& ray : rays) hits += built->accel->intersect(ray, 0, hit);
    return hits;
  };
  const auto build = [built] {
    built->build();
    return std::array{built->world_seconds, built->accel_seconds, built->cpu_seconds};
  };
  return {std::move(name), build, trace, [built] { return built->accel->bytes(); }, {}, {}, {}, {}, 0, 0};
}

Contender make_instances(const std::vector<Vec3f>& centers, float radius, const std::vector<Ray>& rays) {
  auto spheres = std::make_shared<InstancedSpheres>();
  const auto build = [spheres, &centers, radius] {
    spheres->build(centers, radius);
    return std::array{0.0, spheres->wall_seconds, spheres->cpu_seconds};
  };
  const auto trace = [spheres, &rays] { return spheres->trace(rays); };
  const auto bytes = [spheres] { return std::size_t(spheres->bytes); };
  return {"instances of a unit sphere", build, trace, bytes, {}, {}, {}, {}, 0, 0};
}

void print_contenders(const std::vector<Contender>& contenders, std::size_t count, double rays) {
  fmt::print("{} of each; builds on {} threads, rays on one; a solid takes {} bytes of the world\n\n", count,
             thread_count(), sizeof(PlacedSolid));
  fmt::print(
      "| | BVH, s | flattening, s | both, CPU s | bytes each: BVH | bytes each: resident | million rays per "
      "s "
      "| hit |\n|---|---|---|---|---|---|---|---|\n");
  for (const Contender& c : contenders) {
    const auto [low, high] = std::ranges::minmax(c.accel);
    const auto [slow, fast] = std::ranges::minmax(c.rates);
    fmt::print(
        "| {} | {:.2f} ({:.2f} to {:.2f}) | {:.2f} | {:.2f} | {:.0f} | {:.0f} | {:.2f} ({:.2f} to {:.2f}) | "
        "{:.1f}% |\n",
        c.name, median(c.accel), low, high, median(c.world), median(c.cpu), double(c.bytes()) / double(count),
        c.resident / double(count), median(c.rates), slow, fast, 100 * double(c.hits) / rays);
  }
}

void measure_million(std::size_t count) {
  constexpr int kRays = 1'000'000, kRepeats = 5;
  // About half of the rays hit: a count n of radius r stops a path of length s with 1 - exp(-n pi r^2 s).
  const float radius = 0.7f / std::sqrt(float(count));
  // A convex body is seen, on average, with a quarter of its area, so these are hit as often as the spheres.
  const float same_hits = radius * std::sqrt(8 * kPi / (3 * std::sqrt(3.0f)));
  const std::vector<Vec3f> centers = random_centers(count);
  const std::vector<Ray> rays = random_rays(kRays);
  std::vector<Contender> contenders;
  contenders.push_back(make_contender("spheres", sphere_scene(centers, radius), rays));
  contenders.push_back(make_contender("triangles hit as often", triangle_scene(centers, same_hits), rays));
  contenders.push_back(
      make_contender("triangles inscribed in the spheres", triangle_scene(centers, radius), rays));
  contenders.push_back(make_instances(centers, radius, rays));
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (Contender& c : contenders) {
      const double before = resident_bytes();
      const auto [world, accel, cpu] = c.build();
      if (repeat == 0) c.resident = resident_bytes() - before;
      c.world.push_back(world);
      c.accel.push_back(accel);
      c.cpu.push_back(cpu);
    }
  for (int repeat = 0; repeat < kRepeats; ++repeat)
    for (Contender& c : contenders) c.rates.push_back(kRays / time_work(c.trace, c.hits) * 1e-6);
  print_contenders(contenders, count, double(kRays) * kRepeats);
}

}  // namespace

int main(int argc, char** argv) {
  const long count = argc > 1 ? std::atol(argv[1]) : 1'000'000;
  if (count < 1) {
    fmt::print(stderr, "usage: {} [COUNT]\n", argv[0]);
    return 2;
  }
  measure_million(std::size_t(count));
  return 0;
}
