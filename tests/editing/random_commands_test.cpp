// Commands by chance: the scene stays valid, all can be undone and done again, and the session is told
// enough.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "editing/scene_delta.h"
#include "renderer/base/error.h"
#include "renderer/scene/world.h"
#include "tests/editing/support/random_commands.h"
#include "tests/renderer/session/support/session_scenes.h"

namespace parian {
namespace {

/// Runs a command; where it is refused, checks that the scene is as it was. Returns whether it was done.
bool run_or_refuse(RandomCommands& commands, Scene& scene, const Scene& before) {
  try {
    commands.run(scene);
    return true;
  } catch (const UsageError& error) {
    EXPECT_NE(std::string_view(error.what()).find("expected"), std::string_view::npos) << error.what();
    EXPECT_TRUE(scene == before) << error.what();
    return false;
  }
}

TEST(RandomCommands, AreUndoneAndDoneAgain) {
  const Scene first = everything();
  Scene scene = first;
  RandomCommands commands(7);
  std::vector<SceneDelta> done;
  int refused = 0;
  for (int i = 0; i < 10000; ++i) {
    const Scene before = scene;
    if (!run_or_refuse(commands, scene, before)) {
      ++refused;
      continue;
    }
    ASSERT_NO_THROW(validate(scene, "edited")) << "command " << i;
    done.push_back(make_delta(before, scene));
    EXPECT_EQ(done.back().empty(), scene == before);
  }
  // Of both enough, or this tests little.
  EXPECT_GT(done.size(), 6000u);
  EXPECT_GT(refused, 500);
  const Scene last = scene;
  EXPECT_FALSE(last == first);
  for (auto delta = done.rbegin(); delta != done.rend(); ++delta) revert(scene, *delta);
  EXPECT_TRUE(scene == first);
  for (const SceneDelta& delta : done) apply(scene, delta);
  EXPECT_TRUE(scene == last);
}

/// One session that follows all edits has, after each, the picture of one that never knew another scene: also
/// where several edits come at once, and where they are undone.
void follow_edits(unsigned seed, int count, bool editable) {
  RenderSettings settings = small(2);
  settings.width = 24, settings.height = 18;
  settings.accel.editable = editable;
  settings.build = BuildQuality::balanced;
  Scene scene = everything();
  RandomCommands commands(seed);
  Session session = make_session(scene, settings);
  unsigned pending = 0;
  for (int i = 0; i < count; ++i) {
    const Scene before = scene;
    if (!run_or_refuse(commands, scene, before)) continue;
    if (place_cameras(scene).empty()) {
      scene = before;
      continue;
    }
    const SceneDelta delta = make_delta(before, scene);
    pending |= changed(delta);
    if (i % 5 == 4) revert(scene, delta), pending |= changed(delta);
    if (i % 3 == 2) continue;  // comes with the next
    // What needs no update may have another scene, but no other picture.
    if (pending) session.update(std::make_shared<const Scene>(scene), pending);
    pending = 0;
    Session fresh = make_session(scene, settings);
    ASSERT_TRUE(same_bits(finish(session), finish(fresh))) << "command " << i << " of seed " << seed;
  }
}

// Caught: lights untold.
TEST(RandomCommands, AreFollowedByASession) {
  for (unsigned seed = 1; seed <= 3; ++seed) follow_edits(seed, 150, false);
}

TEST(RandomCommands, AreFollowedByAnEditableSession) {
  for (unsigned seed = 11; seed <= 13; ++seed) follow_edits(seed, 150, true);
}

}  // namespace
}  // namespace parian
