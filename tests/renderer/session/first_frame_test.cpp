// First frames: coarse where they must be and nowhere else, and waited for no longer than was said.
#include <gtest/gtest.h>

#include "tests/renderer/session/support/gated_session.h"

namespace parian {
namespace {

RenderSettings with_first_frame(double seconds) {
  RenderSettings settings = small(9);
  settings.accel.editable = true;
  settings.first_frame = seconds;
  return settings;
}

Scene moved_scene(float by) {
  Scene scene = everything();
  scene.nodes[1].transform = translate({0, by, 0});
  return scene;
}

// Of 1, 2, 4, 8 and 9 samples, before an edit and after it. Caught: a frame before those of no fewer
// pixels, a coarse one whatever there is time for, one where none is wanted.
TEST(FirstFrame, IsNotCoarseWhereTheFullOneIsQuickOrNoneIsWanted) {
  for (const double seconds : {0.0, 1e6}) {
    Session session = make_session(everything(), with_first_frame(seconds));
    finish(session);
    EXPECT_EQ(session.frames(), 5u) << seconds;
    session.update(std::make_shared<const Scene>(moved_scene(0.5f)), kChangedTransforms);
    finish(session);
    EXPECT_EQ(session.frames(), 10u) << seconds;
  }
}

// What is seen when the samples of one frame are there, and no more.
TEST(FirstFrame, IsOfTheSizeThatThereIsTimeFor) {
  struct Case {
    double seconds;
    int width, height;
  };
  for (const Case& c : {Case{1e-9, 7, 5}, Case{1e6, 53, 37}, Case{0, 53, 37}}) {
    GatedSession held(everything(), with_first_frame(c.seconds), std::uint64_t(c.width * c.height));
    ASSERT_TRUE(held.start());  // held in the second
    EXPECT_EQ(held.session.frames(), 1u);
    EXPECT_EQ(held.session.snapshot().width, c.width);
    EXPECT_EQ(held.session.snapshot().height, c.height);
  }
}

/// A picture of four tiles, each of 400 packets of camera paths that take 20 ms, so 8 seconds of a thread,
/// where a first frame is wanted in .2.
struct SlowSession : GatedSession {
  static constexpr int kPackets = 1600;
  SlowSession() : GatedSession(everything(), settings()) { gate->sleep = 20; }
  static RenderSettings settings() {
    RenderSettings settings = with_first_frame(0.2);
    settings.width = settings.height = 160;
    settings.tiling.size = 80;  // so that no tile is done in time
    return settings;
  }
  /// An edit while the first frame is rendered. False if it is not applied.
  bool edit() {
    if (!start()) return false;
    const int worlds = gate->worlds;
    session.update(std::make_shared<const Scene>(moved_scene(0.5f)), kChangedTransforms);
    gate->open();
    return wait_until([&] { return gate->worlds > worlds; });
  }
};

// Caught: a first frame that edits wait for to its end.
TEST(FirstFrame, EditsDoNotWaitForASlowOne) {
  SlowSession slow;
  ASSERT_TRUE(slow.edit());
  EXPECT_LT(slow.gate->estimates, SlowSession::kPackets);
}

// One that was given up has told how slow it is. Caught: the full resolution again and again, since too few
// of its tiles were done to know.
TEST(FirstFrame, IsCoarseAfterOneThatWasTooSlow) {
  SlowSession slow;
  ASSERT_TRUE(slow.edit());
  ASSERT_TRUE(wait_until([&] { return slow.session.frames() > 0; }));
  EXPECT_LT(slow.session.snapshot().width, 160);
}

}  // namespace
}  // namespace parian
