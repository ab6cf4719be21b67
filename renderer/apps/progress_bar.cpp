#include "renderer/apps/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

namespace parian {
namespace {

constexpr double kBarInterval = 0.1, kLineInterval = 10;  // seconds

}  // namespace

ProgressBar::ProgressBar(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO)), next_(terminal_ ? 0 : kLineInterval) {}

void ProgressBar::show(const Session& session) {
  if (quiet_) return;
  const Progress progress = session.progress();
  if (progress.seconds < next_) return;
  next_ = progress.seconds + (terminal_ ? kBarInterval : kLineInterval);
  print(session, progress);
}

void ProgressBar::print(const Session& session, const Progress& progress) {
  const std::string samples = progress.total == kNoLimit
                                  ? fmt::format("{} spp", progress.samples)
                                  : fmt::format("{}/{} spp", progress.samples, progress.total);
  const std::string remaining =
      progress.done > 0 ? format_duration(progress.seconds * (1 / progress.done - 1)) : "?";
  const std::string state =
      fmt::format("{}  {} elapsed, {} left, noise {}", samples, format_duration(progress.seconds), remaining,
                  format_noise(session.film().noise()));
  if (terminal_) {
    constexpr int kWidth = 30;
    const int filled = std::clamp(int(progress.done * kWidth), 0, kWidth);
    fmt::print(stderr, "\r[{}{}] {}\033[K", std::string(filled, '#'), std::string(kWidth - filled, '.'),
               state);
    shown_ = true;
  } else {
    fmt::print(stderr, "{}\n", state);
  }
}

void ProgressBar::finish() {
  if (shown_) fmt::print(stderr, "\n");
  shown_ = false;
}

std::string format_noise(const Noise& noise) {
  return std::isfinite(noise.bound)
             ? fmt::format("{:.2f}% (at most {:.2f}%)", 100 * noise.estimate, 100 * noise.bound)
             : "unknown";
}

std::string format_duration(double seconds) {
  const long s = std::lround(seconds);
  return s >= 3600 ? fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60)
                   : fmt::format("{}:{:02}", s / 60, s % 60);
}

}  // namespace parian
