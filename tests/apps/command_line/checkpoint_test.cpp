// Checkpoints: a film comes back to the bit, and a file that is not whole or not of this render is refused.
#include "apps/command_line/checkpoint.h"

#include <gtest/gtest.h>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class Checkpoint : public GltfTest {
 protected:
  static Film film(int width = 5, FilmLayers layers = {true, false, true}) { return {width, 3, layers}; }
  static void fill(Film& f) {
    FilmTile tile = f.checkout({0, 0, f.width(), f.height()});
    float value = 0.1f;
    for (PixelSums& p : tile.pixels)
      for (int i = 0; i < 3; ++i, value += 0.37f) p.add(Rgb(value, value * 2, 1 / value));
    f.merge(tile);
  }
  std::string refused(const std::string& file, const std::string& key, Film& f) {
    try {
      read_checkpoint(file, key, f);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Checkpoint, ComesBackToTheBit) {
  Film saved = film(), restored = film();
  fill(saved);
  write_checkpoint(path("c"), "this render", saved);
  read_checkpoint(path("c"), "this render", restored);
  EXPECT_EQ(restored.save(), saved.save());
  EXPECT_EQ(restored.min_samples(), 3u);
}

TEST_F(Checkpoint, RefusesWhatIsNotOfThisRender) {
  Film saved = film();
  fill(saved);
  write_checkpoint(path("c"), "this render", saved);
  Film other_key = film(), other_size = film(6), other_layers = film(5, {true, false, false});
  EXPECT_NE(refused(path("c"), "that render", other_key).find("this render"), std::string::npos);
  EXPECT_NE(refused(path("c"), "this render", other_size), "");
  EXPECT_NE(refused(path("c"), "this render", other_layers), "");
  EXPECT_EQ(other_key.min_samples(), 0u);
}

// Every length, and a change of any byte.
TEST_F(Checkpoint, RefusesWhatIsNotWhole) {
  Film saved = film(2), restored = film(2);
  fill(saved);
  write_checkpoint(path("c"), "key", saved);
  const std::string whole = read_bytes(path("c"));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(refused(write("cut", whole.substr(0, size)), "key", restored), "") << size;
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string changed = whole;
    changed[i] = char(changed[i] ^ 0x10);
    EXPECT_NE(refused(write("changed", changed), "key", restored), "") << i;
  }
  EXPECT_NE(refused(write("longer", whole + "x"), "key", restored), "");
  EXPECT_EQ(restored.min_samples(), 0u);
}

}  // namespace
}  // namespace parian
