/// What a render cost, for --stats and the closing line.
#pragma once

#include <string>

#include "images/image_memory.h"
#include "renderer/session/session.h"

namespace parian {

struct PhaseSeconds {
  double load = 0, build = 0, render = 0, write = 0;
  double first_ray = 0;  // from the start of the process
};

/// Since this process was started, within a hundredth.
double process_seconds();

/// As JSON: seconds per phase, CPU seconds of the render, samples and noise, rays by kind, camera paths per
/// CPU second, bytes, those of images apart.
std::string stats_json(const SessionStats& stats, const PhaseSeconds& seconds, const Film& film,
                       const ImageMemoryStatistics& images);

}  // namespace parian
