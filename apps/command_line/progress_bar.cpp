#include "apps/command_line/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

namespace parian {
namespace {

constexpr double kBarInterval = 0.1, kLineInterval = 10;  // seconds

}  // namespace

PhaseLine::PhaseLine(bool quiet)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO)), start_(std::chrono::steady_clock::now()) {}

double PhaseLine::elapsed() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void PhaseLine::operator()(const char* phase) {
  const std::lock_guard lock(mutex_);
  phase_ = phase;
  next_ = 0;
  if (quiet_) return;
  if (terminal_) {
    fmt::print(stderr, "\r{}\033[K", phase);
    shown_ = true;
  } else if (elapsed() > kLineInterval) {
    fmt::print(stderr, "{}, {} elapsed\n", phase, format_duration(elapsed()));
  }
}

void PhaseLine::show_share(double done) {
  if (quiet_ || !terminal_) return;
  const std::lock_guard lock(mutex_);
  if (elapsed() < next_) return;
  next_ = elapsed() + kBarInterval;
  fmt::print(stderr, "\r{} {:.0f}%\033[K", phase_, 100 * std::clamp(done, 0.0, 1.0));
}

void PhaseLine::finish() {
  const std::lock_guard lock(mutex_);
  if (shown_) fmt::print(stderr, "\r\033[K");
  shown_ = false;
}

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
