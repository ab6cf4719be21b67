/// A session that a test can hold still in the middle of a pass, so that what comes next does not depend on
/// how fast the machine is.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

#include "tests/renderer/session/support/session_scenes.h"

namespace parian {

/// Asks once a millisecond; false if that is not so after a minute.
template <class Condition>
bool wait_until(const Condition& condition) {
  for (int i = 0; i < 60000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return condition();
}

/// Lets so many camera paths of one sample pass, and holds the others until it is opened.
class Gate {
 public:
  explicit Gate(std::uint64_t allowed) : allowed_(allowed) {}

  void pass(std::uint64_t paths) {
    std::unique_lock lock(mutex_);
    const auto free = [&] { return open_ || passed_ + paths <= allowed_; };
    holding_ += !free();
    changed_.wait(lock, free);
    passed_ += paths;
  }
  void open() {
    const std::lock_guard lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  bool holds() const {
    const std::lock_guard lock(mutex_);
    return holding_ > 0;
  }

  std::atomic<int> sleep{0};                 // milliseconds for each packet of paths that passes
  std::atomic<int> worlds{0}, estimates{0};  // that the integrator was told of; that it began

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t allowed_, passed_ = 0;
  int holding_ = 0;
  bool open_ = false;
};

/// The path integrator behind a gate.
class GatedIntegrator final : public Integrator {
 public:
  explicit GatedIntegrator(std::shared_ptr<Gate> gate) : gate_(std::move(gate)) {}

  void prepare(const World& world) override {
    path_->prepare(world);
    ++gate_->worlds;
  }
  void estimate(const TraceContext& context, std::span<CameraPath> paths, RayCounts& counts,
                bool features_wanted) const override {
    ++gate_->estimates;
    gate_->pass(paths.size());
    if (const int ms = gate_->sleep) std::this_thread::sleep_for(std::chrono::milliseconds(ms));
    path_->estimate(context, paths, counts, features_wanted);
  }

 private:
  std::unique_ptr<Integrator> path_ = make_integrator("path", {});
  std::shared_ptr<Gate> gate_;
};

/// A session that is held once so many paths have passed, at the first by default.
struct GatedSession {
  GatedSession(const Scene& scene, const RenderSettings& settings, std::uint64_t allowed = 0)
      : gate(std::make_shared<Gate>(allowed)),
        session(std::make_shared<const Scene>(scene), settings, std::make_unique<GatedIntegrator>(gate)) {}
  ~GatedSession() { gate->open(); }

  /// Until it is held. False if it is not.
  bool start() {
    session.start();
    return wait_until([&] { return gate->holds(); });
  }

  std::shared_ptr<Gate> gate;
  Session session;
};

}  // namespace parian
