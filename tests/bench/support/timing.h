/// What the benchmarks share: clocks, and a scene with what is built from it.
#pragma once

#include <algorithm>
#include <ctime>
#include <memory>
#include <vector>

#include "renderer/accel/accel.h"

namespace parian {

/// Of a clock of the system, as CLOCK_MONOTONIC or CLOCK_THREAD_CPUTIME_ID.
inline double seconds(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// CPU seconds of this thread that `work` takes; adds what it counts to `hits`.
template <class Work>
double time_work(const Work& work, std::size_t& hits) {
  const double start = seconds(CLOCK_THREAD_CPUTIME_ID);
  hits += work();
  return seconds(CLOCK_THREAD_CPUTIME_ID) - start;
}

/// A scene with what it is traced with, and what building that took; at a fixed address.
struct TimedBuild {
  Scene scene;
  World world;
  std::unique_ptr<Accel> accel;
  double world_seconds = 0, accel_seconds = 0, cpu_seconds = 0;

  /// Anew, if it was built before.
  void build() {
    accel.reset();
    const double start = seconds(CLOCK_MONOTONIC), cpu = seconds(CLOCK_PROCESS_CPUTIME_ID);
    world = make_world(scene);
    const double middle = seconds(CLOCK_MONOTONIC);
    accel = std::make_unique<Accel>(scene, world, AccelSettings{});
    world_seconds = middle - start;
    accel_seconds = seconds(CLOCK_MONOTONIC) - middle;
    cpu_seconds = seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu;
  }
};

}  // namespace parian
