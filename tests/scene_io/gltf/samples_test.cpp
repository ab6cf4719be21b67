// Khronos' sample models, where they are there (beside the checkout, not part of it).
#include <gtest/gtest.h>

#include <set>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

TEST(GltfSamples, LoadOrAreRefusedForARequiredExtension) {
  const std::filesystem::path folder = std::filesystem::path(PARIAN_SOURCE_DIR) / "../shared/assets";
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no " << folder.string();
  int loaded = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".glb" && entry.path().extension() != ".gltf") continue;
    const std::string file = entry.path().string();
    std::vector<std::string> warnings;
    try {
      const Scene scene = load_gltf(file, {}, warnings);
      EXPECT_FALSE(scene.meshes.empty()) << file;
      EXPECT_FALSE(scene.roots.empty()) << file;
      ++loaded;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(": /extensionsRequired/"), std::string::npos) << error.what();
    }
    for (const std::string& warning : warnings) {
      const bool is_true = warning.ends_with("is not supported and is ignored") ||
                           warning.ends_with("points and lines are not drawn");
      EXPECT_TRUE(is_true) << warning;
    }
  }
  EXPECT_GT(loaded, 40);
}

}  // namespace
}  // namespace parian
