/// Progress of a render on stderr: a bar on a terminal, a line now and then when piped.
#pragma once

#include <chrono>
#include <mutex>

#include "renderer/session/session.h"

namespace parian {

/// What goes on before the render: the name of the phase, and its share where that is known. On a terminal a
/// line that goes away; piped, a line for each phase that begins after the first ten seconds, so that the
/// error of what fails at once is the first line.
class PhaseLine {
 public:
  explicit PhaseLine(bool quiet);
  ~PhaseLine() { finish(); }
  void operator()(const char* phase);
  /// 0 to 1; from any thread.
  void show_share(double done);
  /// Removes the line.
  void finish();

 private:
  double elapsed() const;

  bool quiet_, terminal_, shown_ = false;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
  const char* phase_ = "";
  double next_ = 0;
};

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
