/// Progress of a render on stderr: a bar on a terminal, a line now and then when piped.
#pragma once

#include "renderer/session/session.h"

namespace parian {

class ProgressBar {
 public:
  /// `seconds`: the time limit of the render, 0 if it is the samples that end it.
  ProgressBar(bool quiet, double seconds);
  /// Shows the state; cheap enough to be called ten times a second.
  void show(const Session& session);
  /// Ends the bar's line.
  void finish();

 private:
  void print(const Session& session, const Progress& progress);

  bool quiet_, terminal_, shown_ = false;
  double seconds_, next_ = 0;
};

/// h:mm:ss, or m:ss below an hour.
std::string format_duration(double seconds);

}  // namespace parian
