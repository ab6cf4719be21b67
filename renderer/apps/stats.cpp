#include "renderer/apps/stats.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "renderer/base/parallel.h"

namespace parian {

std::size_t peak_memory_bytes() {
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return std::size_t(usage.ru_maxrss) * 1024;
}

std::string stats_json(const SessionStats& s, const PhaseSeconds& seconds, const Film& film) {
  const auto ratio = [](double a, double b) { return b > 0 ? a / b : 0.0; };
  const Noise noise = film.noise();  // what is not finite becomes null
  const nlohmann::ordered_json json = {
      {"version", PARIAN_VERSION},
      {"threads", thread_count()},
      {"samples_per_pixel", film.mean_samples()},
      {"least_samples_per_pixel", film.min_samples()},
      {"noise", {{"estimate", noise.estimate}, {"bound", noise.bound}}},
      {"seconds",
       {{"load", seconds.load},
        {"build", seconds.build},
        {"render", seconds.render},
        {"write", seconds.write}}},
      {"render_cpu_seconds", s.render_cpu_seconds},
      {"rays", {{"camera", s.rays.camera}, {"scattered", s.rays.scattered}, {"shadow", s.rays.shadow}}},
      {"camera_paths_per_cpu_second", ratio(double(s.rays.camera), s.render_cpu_seconds)},
      {"microseconds_per_camera_path", ratio(1e6 * s.render_cpu_seconds, double(s.rays.camera))},
      {"rays_per_camera_path", ratio(double(s.rays.total()), double(s.rays.camera))},
      {"dropped_samples", s.rays.dropped},
      {"triangles", s.triangles},
      {"solids", s.solids},
      {"acceleration_bytes", s.accel_bytes},
      {"acceleration_bytes_per_triangle", ratio(double(s.accel_bytes), double(s.triangles))},
      {"light_bytes", s.light_bytes},
      {"light_build_seconds", s.light_build_seconds},
      {"peak_memory_bytes", peak_memory_bytes()},
  };
  return json.dump(2) + "\n";
}

}  // namespace parian
