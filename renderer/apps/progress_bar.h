/// Progress of a render on stderr: a bar on a terminal, a line now and then when piped.
#pragma once

#include "renderer/session/session.h"

namespace parian {

class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  /// Shows the state; cheap enough to be called ten times a second.
  void show(const Session& session);
  /// Ends the bar's line.
  void finish();

 private:
  void print(const Session& session, const Progress& progress);

  bool quiet_, terminal_, shown_ = false;
  double next_;
};

/// In percent, the estimate and the bound; unknown where a pixel has one sample alone.
std::string format_noise(const Noise& noise);

/// h:mm:ss, or m:ss below an hour.
std::string format_duration(double seconds);

}  // namespace parian
