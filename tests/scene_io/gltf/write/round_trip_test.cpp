// Whole files: every scene of the repository, and models of others where they are there.
#include <gtest/gtest.h>

#include "tests/scene_io/support/round_trip.h"

namespace parian {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> scene_files(const fs::path& folder) {
  std::vector<std::string> files;
  if (!fs::is_directory(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
      files.push_back(entry.path().string());
  std::ranges::sort(files);
  return files;
}

/// Which part of two scenes differs first; empty where none does.
std::string difference(const Scene& a, const Scene& b) {
  const auto items = [](const char* name, const auto& x, const auto& y) {
    if (x.size() != y.size()) return fmt::format("{}: {} and {}", name, x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i)
      if (!(x[i] == y[i])) return fmt::format("{} {}", name, i);
    return std::string();
  };
  for (const std::string& text :
       {items("roots", a.roots, b.roots), items("node", a.nodes, b.nodes), items("mesh", a.meshes, b.meshes),
        items("shape", a.shapes, b.shapes), items("material", a.materials, b.materials),
        items("texture", a.textures, b.textures), items("image", a.images, b.images),
        items("camera", a.cameras, b.cameras), items("light", a.lights, b.lights)})
    if (!text.empty()) return text;
  return a == b ? "" : "environment";
}

class RoundTrip : public WriteTest {
 protected:
  /// Written as .glb and .gltf: an equal scene, and once more the same bytes.
  void expect_round_trip(const std::string& file) {
    const Loaded loaded = load_with_source(file);
    for (const std::string extension : {".glb", ".gltf"}) {
      for (const char* folder : {"a", "b"}) fs::create_directories(path(folder));
      const std::string first = path("a/x" + extension), second = path("b/x" + extension);
      write_gltf(loaded.scene, loaded.sources, first);
      const Loaded again = load_with_source(first);
      ASSERT_EQ(difference(loaded.scene, again.scene), "") << file << " as " << extension;
      write_gltf(again.scene, again.sources, second);
      EXPECT_EQ(read_bytes(first), read_bytes(second)) << file << " as " << extension;
      EXPECT_EQ(read_bytes(path("a/x.bin")), read_bytes(path("b/x.bin"))) << file;
      for (const char* folder : {"a", "b"}) fs::remove_all(path(folder));
    }
  }
};

TEST_F(RoundTrip, OfEveryScene) {
  const auto files = scene_files(fs::path(PARIAN_SOURCE_DIR) / "scenes");
  ASSERT_GT(files.size(), 40u);
  for (const std::string& file : files) expect_round_trip(file);
}

TEST_F(RoundTrip, OfModelsOfOthers) {
  const fs::path folder = fs::path(PARIAN_SOURCE_DIR) / "../shared/assets/khronos";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "no " << folder.string();
  for (const std::string& file : scene_files(folder)) expect_round_trip(file);
}

class NightlyRoundTrip : public RoundTrip {};

TEST_F(NightlyRoundTrip, OfLargeModels) {
  const fs::path folder = fs::path(PARIAN_SOURCE_DIR) / "../shared/assets/models";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "no " << folder.string();
  for (const std::string& file : scene_files(folder)) expect_round_trip(file);
}

/// In the pose of an animation: the pose becomes that of the file.
TEST_F(RoundTrip, OfAPose) {
  const fs::path folder = fs::path(PARIAN_SOURCE_DIR) / "../shared/assets/khronos";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "no " << folder.string();
  for (const char* name :
       {"AnimatedMorphCube.glb", "CesiumMan.glb", "BrainStem.glb", "InterpolationTest.glb"}) {
    LoadSettings posed;
    posed.at = 0.6;
    const Loaded loaded = load_with_source((folder / name).string(), posed);
    EXPECT_EQ(difference(loaded.scene, again(loaded).scene), "") << name;
    std::vector<std::string> notes;
    EXPECT_EQ(difference(loaded.scene, load_gltf(path("again.glb"), posed, notes)), "") << name;
  }
}

}  // namespace
}  // namespace parian
