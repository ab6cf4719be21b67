#include "renderer/compare/layers.h"

#include <gtest/gtest.h>

#include "renderer/base/error.h"

namespace parian {
namespace {

using Names = std::vector<std::string>;

Picture picture(const Names& channels, int width = 2, int height = 1) {
  Picture p{width, height, channels, {}, {}};
  for (int i = 0; i < width * height * int(channels.size()); ++i) p.pixels.push_back(float(i));
  return p;
}

Names compared(const Names& test, const Names& reference, const std::string& layer = "") {
  return layers_to_compare(picture(test), "t.exr", picture(reference), "r.exr", layer);
}

/// The message of the error that comparing these gives.
template <class Error>
std::string refusal(const Names& test, const Names& reference, const std::string& layer = "") {
  try {
    compared(test, reference, layer);
  } catch (const Error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Layers, AreWhatIsBeforeTheDot) {
  EXPECT_EQ(layer_of("R"), "rgb");
  EXPECT_EQ(layer_of("A"), "rgb");
  EXPECT_EQ(layer_of("Y"), "rgb");
  EXPECT_EQ(layer_of("albedo.R"), "albedo");
  EXPECT_EQ(layer_of("view.left.G"), "view.left");
  EXPECT_EQ(layer_of("samples"), "samples");
  EXPECT_EQ(layer_names(picture({"R", "G", "B", "depth.Z", "samples"})), (Names{"rgb", "depth", "samples"}));
}

TEST(Layers, AllButThoseOfTheEstimateAreCompared) {
  const Names rgb{"R", "G", "B"}, full{"R", "G", "B", "variance.R", "variance.G", "variance.B", "samples"};
  EXPECT_EQ(compared(rgb, full), Names{"rgb"});
  EXPECT_EQ(compared(full, rgb), Names{"rgb"});
  EXPECT_EQ(compared({"R", "depth.Z"}, {"R", "depth.Z"}), (Names{"rgb", "depth"}));
  EXPECT_EQ(compared({"R", "depth.Z"}, {"R"}, "rgb"), Names{"rgb"});
  EXPECT_EQ(compared(full, full, "samples"), Names{"samples"});
}

TEST(Layers, RefusesWhatCannotBeCompared) {
  EXPECT_EQ(
      refusal<InputError>({"R"}, {"R", "albedo.R", "depth.Z"}),
      "t.exr: has no albedo, depth; expected the layers of r.exr. --layer NAME (--layer rgb) compares one "
      "alone");
  EXPECT_TRUE(refusal<InputError>({"R", "depth.Z"}, {"R"}).starts_with("r.exr: has no depth;"));
  EXPECT_EQ(refusal<InputError>({"Y"}, {"R", "G", "B"}), "t.exr: channels Y; expected R, G, B as r.exr has");
  EXPECT_EQ(refusal<InputError>({"R", "G", "B", "A"}, {"R", "G", "B"}),
            "t.exr: channels R, G, B, A; expected R, G, B as r.exr has");
  EXPECT_EQ(refusal<InputError>({"normal.R"}, {"normal.X"}),
            "t.exr: channels normal.R; expected normal.X as r.exr has");
  EXPECT_EQ(refusal<InputError>({"R"}, {"R", "depth.Z"}, "depth"),
            "t.exr: has no layer depth; there are: rgb");
  EXPECT_EQ(refusal<UsageError>({"R"}, {"R"}, "depth"), "--layer depth: no such layer; there are: rgb");
  const Picture small = picture({"R"}), large = picture({"R"}, 3, 4);
  EXPECT_THROW(layers_to_compare(small, "t", large, "r", ""), InputError);
}

TEST(Layers, SelectedOnesAreInTheSameOrder) {
  const Picture p = select_layer(picture({"depth.Z", "B", "G", "R"}), "rgb");
  EXPECT_EQ(p.channels, (Names{"R", "G", "B"}));
  EXPECT_EQ(p.pixels, (std::vector<float>{3, 2, 1, 7, 6, 5}));
}

TEST(Layers, PlanesAreLinear) {
  Picture p{1, 1, {"R", "G", "B"}, {0.5f, 0.04f, 1}, {}};
  const RgbPlanes linear = rgb_planes(p, false), decoded = rgb_planes(p, true);
  EXPECT_EQ(linear.g.values[0], 0.04f);
  EXPECT_NEAR(decoded.r.values[0], 0.214041, 1e-6);
  EXPECT_NEAR(decoded.g.values[0], 0.04 / 12.92, 1e-7);
  EXPECT_NEAR(decoded.b.values[0], 1, 1e-6);
  p.channels = {"Y", "A", "depth.Z"};
  EXPECT_EQ(rgb_planes(p, false).b.values[0], 0.5f);
  p.channels = {"X", "A", "B"};
  EXPECT_TRUE(rgb_planes(p, false).r.values.empty());
}

}  // namespace
}  // namespace parian
