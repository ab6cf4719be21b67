#include "apps/command_line/stats.h"

#include <unistd.h>

#include <nlohmann/json.hpp>

#include <ctime>
#include <fstream>
#include <sstream>

#include "renderer/base/memory.h"
#include "renderer/base/parallel.h"

namespace parian {

double process_seconds() {
  // Field 22 of the line, in ticks since the machine was started; the name, field 2, ends with the last ")".
  std::ifstream file("/proc/self/stat");
  std::string line, field;
  std::getline(file, line);
  std::istringstream fields(line.substr(line.rfind(')') + 1));
  for (int i = 3; i <= 22; ++i) fields >> field;
  timespec now;
  clock_gettime(CLOCK_BOOTTIME, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec) -
         std::strtod(field.c_str(), nullptr) / double(sysconf(_SC_CLK_TCK));
}

std::string stats_json(const SessionStats& s, const PhaseSeconds& seconds, const Film& film,
                       const ImageMemoryStatistics& images) {
  const auto ratio = [](double a, double b) { return b > 0 ? a / b : 0.0; };
  constexpr const char* kQualities[] = {"fast", "balanced", "best"};
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
      {"seconds_to_first_ray", seconds.first_ray},
      {"render_cpu_seconds", s.render_cpu_seconds},
      {"rays", {{"camera", s.rays.camera}, {"scattered", s.rays.scattered}, {"shadow", s.rays.shadow}}},
      {"camera_paths_per_cpu_second", ratio(double(s.rays.camera), s.render_cpu_seconds)},
      {"microseconds_per_camera_path", ratio(1e6 * s.render_cpu_seconds, double(s.rays.camera))},
      {"rays_per_camera_path", ratio(double(s.rays.total()), double(s.rays.camera))},
      {"dropped_samples", s.rays.dropped},
      {"triangles", s.triangles},
      {"solids", s.solids},
      {"build", kQualities[std::size_t(s.quality)]},
      {"compact", s.compact},
      {"acceleration_bytes", s.accel_bytes},
      {"acceleration_bytes_per_triangle", ratio(double(s.accel_bytes), double(s.triangles))},
      {"light_bytes", s.light_bytes},
      {"light_build_seconds", s.light_build_seconds},
      {"images",
       {{"memory_bytes", images.memory_bytes},
        {"file_bytes", images.cache.file_bytes},
        {"cache_bytes", images.cache_bytes},
        {"cache_peak_bytes", images.cache.peak_bytes},
        {"tile_reads", images.cache.tile_reads}}},
      {"peak_memory_bytes", peak_memory()},
      {"predicted_peak_memory_bytes", s.predicted_peak},
  };
  return json.dump(2) + "\n";
}

}  // namespace parian
