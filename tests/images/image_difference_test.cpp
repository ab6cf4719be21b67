#include "images/image_difference.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <vector>

#include "renderer/base/error.h"

namespace parian {
namespace {

Picture picture(int width, int height, const std::function<float(int, int, int)>& value) {
  Picture p{width, height, {"R", "G"}, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 2; ++c) p.pixels.push_back(value(x, y, c));
  return p;
}

// Half of the pixels too bright by .5 and half too dark by .25, and a channel that is right.
TEST(ImageDifference, SumsAreThoseOfTheFormulas) {
  const auto value = [](int x, int y, int c) { return float(x + 10 * y + c); };
  const Picture reference = picture(10, 6, value);
  const Picture test = picture(10, 6, [&](int x, int y, int c) {
    return value(x, y, c) + (c == 1 ? 0 : x < 5 ? 0.5f : -0.25f);
  });
  const std::vector<ChannelDifference> d = channel_differences(test, reference);
  ASSERT_EQ(d.size(), 2u);
  EXPECT_EQ(d[0].channel, "R");
  EXPECT_NEAR(d[0].mean, 0.125, 1e-9);
  EXPECT_NEAR(d[0].mean_absolute, 0.375, 1e-9);
  EXPECT_NEAR(d[0].mean_square, (0.25 + 0.0625) / 2, 1e-9);
  EXPECT_EQ(d[0].lowest, -0.25);
  EXPECT_EQ(d[0].highest, 0.5);
  EXPECT_EQ(d[1].channel, "G");
  EXPECT_EQ(d[1].mean_square, 0);
  EXPECT_EQ(d[1].highest, 0);
}

// Caught: a mean over what is left.
TEST(ImageDifference, NoMeanWherePixelsAreNotFinite) {
  const Picture good = picture(10, 6, [](int, int, int) { return 1.0f; });
  for (const float value : {NAN, INFINITY, -INFINITY}) {
    Picture bad = good;
    bad.at(3, 2)[0] = value;
    using Pair = std::pair<const Picture*, const Picture*>;
    for (const auto& [t, r] : {Pair(&bad, &good), Pair(&good, &bad), Pair(&bad, &bad)}) {
      const std::vector<ChannelDifference> d = channel_differences(*t, *r);
      for (const double number : {d[0].mean, d[0].mean_absolute, d[0].mean_square, d[0].lowest, d[0].highest})
        EXPECT_TRUE(std::isnan(number));
      EXPECT_EQ(d[1].mean, 0);
    }
  }
}

// A folder of the test's own, gone with it.
class ImageFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("parian_difference_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// A grey image of one pixel, with what `change` adds to its header.
  std::string write(const std::string& name, const std::function<void(OIIO::ImageSpec&)>& change = {}) const {
    OIIO::ImageSpec spec(1, 1, 3, name.ends_with(".exr") ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    if (change) change(spec);
    const auto output = OIIO::ImageOutput::create(path(name));
    const float pixel[3] = {0.5f, 0.5f, 0.5f};
    EXPECT_TRUE(output->open(path(name), spec) && output->write_image(OIIO::TypeDesc::FLOAT, pixel) &&
                output->close());
    return path(name);
  }

 private:
  std::filesystem::path folder_;
};

void set_chromaticities(OIIO::ImageSpec& spec, const std::array<float, 8>& values) {
  spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), values.data());
}

TEST_F(ImageFiles, EncodingIsOfTheFormatAndItsHeader) {
  EXPECT_EQ(read_color_encoding(write("a.exr")).transfer, "linear");
  EXPECT_EQ(read_color_encoding(write("a.hdr")).transfer, "linear");
  EXPECT_EQ(read_color_encoding(write("a.png")).transfer, "sRGB");
  EXPECT_EQ(read_color_encoding(write("a.jpg")).transfer, "sRGB");
  EXPECT_TRUE(same_chromaticities(read_color_encoding(path("a.exr")), {}));
  const std::array<float, 8> acescg{0.713f, 0.293f, 0.165f, 0.83f, 0.128f, 0.044f, 0.32168f, 0.33767f};
  write("aces.exr", [&](OIIO::ImageSpec& spec) { set_chromaticities(spec, acescg); });
  EXPECT_EQ(read_color_encoding(path("aces.exr")).chromaticities, acescg);
}

TEST_F(ImageFiles, OtherEncodingsAreRefused) {
  write("linear.exr");
  write("other.exr", [](OIIO::ImageSpec& spec) {
    set_chromaticities(spec, {0.7f, 0.3f, 0.2f, 0.7f, 0.15f, 0.06f, 0.3127f, 0.3290f});
  });
  write("same.exr", [](OIIO::ImageSpec& spec) { set_chromaticities(spec, ColorEncoding::kRec709); });
  write("display.png");
  EXPECT_NO_THROW(shared_color_encoding(path("same.exr"), path("linear.exr")));
  EXPECT_NO_THROW(shared_color_encoding(path("other.exr"), path("other.exr")));
  EXPECT_THROW(shared_color_encoding(path("other.exr"), path("linear.exr")), InputError);
  EXPECT_THROW(shared_color_encoding(path("display.png"), path("linear.exr")), InputError);
  EXPECT_THROW(shared_color_encoding(path("linear.exr"), path("display.png")), InputError);
}

// Colours of the map at 0, 1/3, 2/3 and 1 (van der Walt and Smith 2015), as near as the library has them.
// Caught: its linear light written as it is, twice as dark; NaN as 0.
TEST_F(ImageFiles, HeatMapIsMagma) {
  const std::vector<float> values{0, 1 / 3.0f, 2 / 3.0f, 1, -1, 2, NAN, INFINITY};
  write_heat_map(values, 4, 2, path("map.png"));
  const Picture map = read_picture(path("map.png"));
  const float expected[4][3] = {
      {0.001f, 0.000f, 0.014f}, {0.445f, 0.123f, 0.507f}, {0.945f, 0.378f, 0.365f}, {0.987f, 0.991f, 0.750f}};
  for (int c = 0; c < 3; ++c) {
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(map.at(x, 0)[c], expected[x][c], 0.025) << x << c;
    EXPECT_EQ(map.at(0, 1)[c], map.at(0, 0)[c]);
    for (int x = 1; x < 4; ++x) EXPECT_EQ(map.at(x, 1)[c], map.at(3, 0)[c]);
  }
  EXPECT_THROW(write_heat_map(values, 4, 2, path("nowhere/map.png")), InputError);
}

}  // namespace
}  // namespace parian
