// Broken documents with morph targets, a skin and an animation: nothing worse than a refusal ever happens.
#include <gtest/gtest.h>

#include <random>

#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

class GltfPoseBroken : public GltfTest {
 protected:
  void SetUp() override {
    GltfTest::SetUp();
    settings.at = 0.5;
    const int positions = builder_.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int normals = builder_.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int joints = builder_.add<std::uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4");
    const int weights = builder_.add<float>({1, 0, 0, 0, .5f, .5f, 0, 0, 1, 0, 0, 0}, "VEC4");
    json& primitive = builder_.add_mesh(
        {{"POSITION", positions}, {"NORMAL", normals}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    primitive["targets"] = {{{"POSITION", normals}, {"NORMAL", positions}}, {{"POSITION", normals}}};
    builder_.root["meshes"][0]["weights"] = {0, 1};
    const int matrices = builder_.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,  //
                                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                                             "MAT4");
    const int times = builder_.add<float>({0, 1}, "SCALAR");
    const int rotations = builder_.add<float>({0, 0, 0, 1, 0, 0, 1, 0}, "VEC4");
    const int values = builder_.add<float>({0, 1, 1, 0, 0, 0, 0, 0, 0, 1, 0, 0}, "SCALAR");
    builder_.root["skins"] = {{{"joints", {0, 1}}, {"inverseBindMatrices", matrices}, {"skeleton", 0}}};
    builder_.root["nodes"] = {{{"children", {1}}},
                              {{"translation", {0, 1, 0}}},
                              {{"mesh", 0}, {"skin", 0}, {"weights", {1, 0}}},
                              {{"mesh", 0}, {"weights", {2, 3}}}};
    json animation;
    animation["samplers"] = {{{"input", times}, {"output", rotations}},
                             {{"input", times}, {"output", values}, {"interpolation", "CUBICSPLINE"}}};
    animation["channels"] = {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}},
                             {{"sampler", 1}, {"target", {{"node", 2}, {"path", "weights"}}}}};
    builder_.root["animations"] = {animation};
  }

  GltfBuilder builder_;
};

TEST_F(GltfPoseBroken, IsWholeWhenLeftAlone) {
  EXPECT_EQ(refusal(builder_.glb()), "");
  EXPECT_EQ(warnings, std::vector<std::string>());
}

TEST_F(GltfPoseBroken, SurvivesFlippedBytes) {
  const std::string good = builder_.glb();
  std::mt19937 random(1);
  int refused = 0;
  constexpr int kRounds = 1000;
  for (int i = 0; i < kRounds; ++i) {
    std::string bad = good;
    for (std::uint32_t flips = 1 + random() % 4; flips > 0; --flips)
      bad[random() % bad.size()] = char(random());
    refused += !refusal(bad).empty();
  }
  EXPECT_GT(refused, kRounds / 2);
}

TEST_F(GltfPoseBroken, SurvivesMisplacedValues) {
  const json flat = builder_.root.flatten();
  std::vector<json::json_pointer> places;
  for (const auto& [key, value] : flat.items()) {
    for (json::json_pointer place(key); !place.empty(); place.pop_back()) places.push_back(place);
  }
  const std::vector<json> values = {
      nullptr,       true,           0,   1,     2, 3, 4, 5, 6, 7, 8, 255, 65535, 1e38, "", "x",
      json::array(), json::object(), {0}, {1e38}};
  std::mt19937 random(1);
  int refused = 0;
  constexpr int kRounds = 1500;
  for (int i = 0; i < kRounds; ++i) {
    GltfBuilder bad = builder_;
    bad.root[places[random() % places.size()]] = values[random() % values.size()];
    refused += !refusal(bad.glb()).empty();
  }
  EXPECT_GT(refused, kRounds / 2);
}

// Nodes cost a few bytes, the meshes made for them many: what all take is bounded by the file.
TEST_F(GltfPoseBroken, RefusesMeshesWithoutEnd) {
  GltfBuilder big;
  constexpr std::size_t kVertices = 99'999;
  big.root["accessors"] = {{{"componentType", 5126}, {"count", kVertices}, {"type", "VEC3"}}};
  big.add_mesh({{"POSITION", 0}})["targets"] = {{{"POSITION", 0}}};
  for (int i = 1; i <= 200; ++i) big.root["nodes"].push_back({{"mesh", 0}, {"weights", {i}}});
  EXPECT_EQ(refusal(big.glb()).substr(0, 26), "/meshes/0/primitives/0: ex");
}

}  // namespace
}  // namespace parian
