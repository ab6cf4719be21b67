// How samples are cut into passes, at whose ends there is something new to see.
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <thread>

#include "renderer/session/session.h"
#include "tests/renderer/session/support/session_scenes.h"

namespace parian {
namespace {

/// Takes its time for each packet of camera paths, one after the other on however many threads.
class SlowIntegrator : public Integrator {
 public:
  void estimate(const TraceContext&, std::span<CameraPath> paths, RayCounts&, bool) const override {
    const std::lock_guard lock(mutex_);
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
    for (CameraPath& path : paths) path.radiance = Rgb(1);
  }

 private:
  mutable std::mutex mutex_;
};

std::uint64_t count_frames(double first_frame) {
  RenderSettings settings = small(8);
  settings.width = settings.height = 8 * kBlock;  // 64 packets: a sample of all takes 256 ms
  settings.first_frame = first_frame;
  settings.layers = {};
  Session session(std::make_shared<const Scene>(everything()), settings, std::make_unique<SlowIntegrator>());
  finish(session);
  return session.frames();
}

TEST(Passes, AreShortWhereSomebodyWatches) {
  EXPECT_EQ(count_frames(0), 4u);   // of 1, 1, 2, 4 samples
  EXPECT_GE(count_frames(10), 5u);  // of 1, 1, 2, 2, 2
}

}  // namespace
}  // namespace parian
