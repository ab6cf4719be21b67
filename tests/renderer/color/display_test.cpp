#include "renderer/color/display.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "renderer/base/error.h"

namespace parian {
namespace {

using Color = std::array<float, 3>;

Picture row_of(const std::vector<Color>& colors) {
  Picture picture;
  picture.width = int(colors.size());
  picture.height = 1;
  picture.channels = {"R", "G", "B"};
  for (const Color& color : colors) picture.pixels.insert(picture.pixels.end(), color.begin(), color.end());
  return picture;
}

std::vector<Color> shown(const std::vector<Color>& colors, const std::string& view, float exposure = 0) {
  const Picture picture = apply_display(row_of(colors), view, exposure);
  EXPECT_EQ(picture.channels, (std::vector<std::string>{"R", "G", "B"}));
  std::vector<Color> result;
  for (int x = 0; x < picture.width; ++x) {
    const float* pixel = picture.at(x, 0);
    result.push_back({pixel[0], pixel[1], pixel[2]});
  }
  return result;
}

// IEC 61966-2-1.
double srgb(double linear) {
  linear = std::clamp(linear, 0.0, 1.0);
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// The specification of Khronos PBR Neutral as it is written, then the sRGB curve.
std::array<double, 3> neutral(const Color& color) {
  const double f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
  const double x = std::min({color[0], color[1], color[2]});
  const double f = x <= 2 * f90 ? x - x * x / (4 * f90) : f90;
  const double p = std::max({color[0], color[1], color[2]}) - f;
  const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks);
  const double g = 1 / (kd * (p - pn) + 1);
  std::array<double, 3> out;
  for (std::size_t c = 0; c < 3; ++c) {
    const double d = color[c] - f;
    out[c] = srgb(p <= ks ? d : d * pn / p * g + pn * (1 - g));
  }
  return out;
}

template <class Error, class Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// $OCIO for the length of a test.
class WithConfig {
 public:
  explicit WithConfig(const std::string& path) { setenv("OCIO", path.c_str(), 1); }
  ~WithConfig() { unsetenv("OCIO"); }
};

class Display : public testing::Test {
 protected:
  void SetUp() override { unsetenv("OCIO"); }
  std::string write_config(const std::string& text) const {
    const std::string path = testing::TempDir() + "parian_" +
                             testing::UnitTest::GetInstance()->current_test_info()->name() + ".ocio";
    std::ofstream(path) << text;
    return path;
  }
};

TEST_F(Display, HasThreeViewsPlainFirst) {
  EXPECT_EQ(display_views(), (std::vector<std::string>{"sRGB", "ACES 1.0 SDR", "Khronos PBR Neutral"}));
}

TEST_F(Display, PlainViewIsTheSrgbCurve) {
  std::vector<Color> colors;
  for (int i = 0; i <= 1000; ++i) {
    const float t = float(i) / 1000;
    colors.push_back({t, t * t * t * 0.01f, 1 - t});
  }
  for (const std::string view : {"", "sRGB"}) {
    const auto result = shown(colors, view);
    for (std::size_t i = 0; i < colors.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(result[i][c], srgb(colors[i][c]), 1e-4) << colors[i][c];
  }
}

TEST_F(Display, ExposureCountsInStops) {
  EXPECT_NEAR(shown({{0.1f, 0.1f, 0.1f}}, "sRGB", 1.5f)[0][0], srgb(0.1 * std::exp2(1.5)), 1e-4);
  EXPECT_NEAR(shown({{0.1f, 0.1f, 0.1f}}, "sRGB", -2)[0][0], srgb(0.025), 1e-4);
}

TEST_F(Display, NeutralFollowsTheFormula) {
  // Greys, saturated colours, colours of 14 stops below to 12 above white, and colours near the knees of the
  // curve.
  std::vector<Color> colors{{0, 0, 0}, {1, 1, 1}, {0.08f, 0.08f, 0.08f}, {0.8f, 0.8f, 0.8f}, {0, 0, 4096}};
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  const auto stops = [&](float low, float high) { return std::exp2(low + (high - low) * uniform(random)); };
  for (int i = 0; i < 20000; ++i) {
    colors.push_back({stops(-14, 12), stops(-14, 12), stops(-14, 12)});
    const float scale = stops(-10, 12);
    colors.push_back({scale * uniform(random), scale * uniform(random), scale * uniform(random)});
    colors.push_back({uniform(random), i % 2 ? 0 : 0.1f * uniform(random), i % 3 ? 0 : uniform(random)});
    colors.push_back({0.7f + 0.2f * uniform(random), 0.06f + 0.04f * uniform(random), uniform(random)});
    colors.push_back({scale, scale, scale});
  }
  const auto result = shown(colors, "Khronos PBR Neutral");
  double worst = 0;
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto expected = neutral(colors[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      const double error = std::abs(result[i][c] - expected[c]);
      EXPECT_LT(error, 0.1 / 255) << colors[i][0] << " " << colors[i][1] << " " << colors[i][2] << " channel "
                                  << c;
      worst = std::max(worst, error);
    }
  }
  RecordProperty("worst_error_times_255", std::to_string(worst * 255));
}

TEST_F(Display, NeutralKeepsBaseColoursLessFourPercent) {
  // What the view is for: in [0.08, 0.8] it subtracts the 4 % that a dielectric reflects, and changes nothing
  // else.
  const auto result = shown({{0.2f, 0.5f, 0.8f}}, "Khronos PBR Neutral");
  EXPECT_NEAR(result[0][0], srgb(0.16), 2e-4);
  EXPECT_NEAR(result[0][1], srgb(0.46), 2e-4);
  EXPECT_NEAR(result[0][2], srgb(0.76), 2e-4);
}

TEST_F(Display, AcesRisesWithLightAndShowsMidGreyDark) {
  std::vector<Color> greys;
  for (int i = 0; i < 200; ++i) {
    const float grey = std::exp2(-9 + 0.08f * float(i));
    greys.push_back({grey, grey, grey});
  }
  const auto result = shown(greys, "ACES 1.0 SDR");
  for (std::size_t i = 1; i < result.size(); ++i) {
    EXPECT_GE(result[i][1], result[i - 1][1]) << greys[i][0];
    // Grey in, grey out: the white of Rec.709 goes to that of the display.
    EXPECT_NEAR(result[i][0], result[i][1], 2e-3);
    EXPECT_NEAR(result[i][2], result[i][1], 2e-3);
  }
  // The ACES tone scale puts 0.18 at a tenth of white (4.8 of 48 nits).
  EXPECT_NEAR(shown({{0.18f, 0.18f, 0.18f}}, "ACES 1.0 SDR")[0][1], srgb(0.1), 0.01);
  EXPECT_GT(result.back()[1], 0.95f);
  // A dull colour keeps its hue: the ratios of its channels grow with the contrast of the curve, both by the
  // same.
  const Color dull = shown({{0.22f, 0.18f, 0.14f}}, "ACES 1.0 SDR")[0];
  const auto linear = [](double v) { return std::pow((v + 0.055) / 1.055, 2.4); };
  EXPECT_NEAR(std::log(linear(dull[0]) / linear(dull[1])) / std::log(0.22 / 0.18), 1.35, 0.25);
  EXPECT_NEAR(std::log(linear(dull[1]) / linear(dull[2])) / std::log(0.18 / 0.14), 1.35, 0.25);
}

TEST_F(Display, StaysInRangeWhateverComesIn) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Color> colors{{-1, -2, -3},       {-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f},
                            {1e38f, -1e38f, 0}, {inf, inf, inf},          {inf, -inf, nan},
                            {nan, nan, nan},    {1e-40f, 0, 1e-40f}};
  for (const std::string& view : display_views())
    for (const float exposure : {0.0f, 30.0f, -30.0f})
      for (const Color& color : shown(colors, view, exposure))
        for (const float value : color) EXPECT_TRUE(value >= 0 && value <= 1) << view << " " << value;
  EXPECT_EQ(shown({{-1, -2, -3}}, "sRGB")[0], (Color{0, 0, 0}));
  EXPECT_EQ(shown({{1e30f, inf, 2}}, "sRGB")[0], (Color{1, 1, 1}));
}

TEST_F(Display, TakesTheBeautyOutOfLayers) {
  Picture picture;
  picture.width = picture.height = 1;
  picture.channels = {"depth", "B", "albedo.R", "R", "G"};
  picture.pixels = {7, 0.1f, 9, 0.3f, 0.2f};
  const Picture result = apply_display(picture, "sRGB");
  EXPECT_NEAR(result.pixels[0], srgb(0.3), 1e-4);
  EXPECT_NEAR(result.pixels[1], srgb(0.2), 1e-4);
  EXPECT_NEAR(result.pixels[2], srgb(0.1), 1e-4);
  picture.channels[3] = "X";
  EXPECT_NE(error_of<InputError>([&] { apply_display(picture, "sRGB"); }).find("no channel R"),
            std::string::npos);
}

TEST_F(Display, UnknownViewNamesThoseThereAre) {
  const std::string message = error_of<UsageError>([] { shown({{0, 0, 0}}, "Filmic"); });
  EXPECT_NE(message.find("no view \"Filmic\""), std::string::npos) << message;
  EXPECT_NE(message.find("sRGB, ACES 1.0 SDR, Khronos PBR Neutral"), std::string::npos) << message;
}

TEST_F(Display, MissingOrBrokenConfigIsAnError) {
  {
    const WithConfig config("/no/such/config.ocio");
    EXPECT_NE(error_of<InputError>([] { display_views(); }).find("/no/such/config.ocio: "),
              std::string::npos);
    EXPECT_NE(error_of<InputError>([] {
                shown({{0, 0, 0}}, "");
              }).find("/no/such/config.ocio: "),
              std::string::npos);
  }
  {
    const WithConfig config(write_config("no config at all"));
    EXPECT_NE(error_of<InputError>([] { shown({{0, 0, 0}}, ""); }), "");
  }
}

// The least config of someone else: one colour space named as given, one view of gamma 2.
std::string foreign_config(const std::string& roles, const std::string& space, const std::string& view) {
  return "ocio_profile_version: 2\nsearch_path: .\nroles: {default: " + space + roles + "}\n" +
         "file_rules: [!<Rule> {name: Default, colorspace: default}]\n" +
         "displays:\n  Monitor:\n    - !<View> {name: Other, colorspace: " + space + "}\n" +
         "    - !<View> {name: Square, colorspace: Square}\nactive_displays: []\nactive_views: [Square, "
         "Other]\n" +
         "colorspaces:\n  - !<ColorSpace> {name: " + space + "}\n" +
         "  - !<ColorSpace> {name: Square, from_scene_reference: " + view + "}\n";
}
const std::string kSquareRoot = "!<ExponentTransform> {value: 2, direction: inverse}";

TEST_F(Display, UsesTheConfigOfTheEnvironment) {
  const WithConfig config(write_config(foreign_config("", "Utility - Linear - sRGB", kSquareRoot)));
  EXPECT_EQ(display_views(), (std::vector<std::string>{"Square", "Other"}));
  EXPECT_NEAR(shown({{0.25f, 0.04f, 0.81f}}, "")[0][0], 0.5f, 1e-4);
  EXPECT_NEAR(shown({{0.25f, 0.04f, 0.81f}}, "Other")[0][0], 0.25f, 1e-4);
  EXPECT_NE(error_of<UsageError>([] {
              shown({{0, 0, 0}}, "sRGB");
            }).find("there are: Square, Other"),
            std::string::npos);
}

TEST_F(Display, FindsRec709ThroughTheAcesInterchange) {
  const WithConfig config(write_config(foreign_config(", aces_interchange: AP0", "AP0", kSquareRoot)));
  // A grey keeps its value between the two; a red does not.
  EXPECT_NEAR(shown({{0.25f, 0.25f, 0.25f}}, "")[0][1], 0.5f, 1e-3);
  // Rec.709 red in ACES2065-1, Bradford adapted: 0.4396, 0.0898, 0.0175.
  const Color red = shown({{1, 0, 0}}, "")[0];
  EXPECT_NEAR(red[0], std::sqrt(0.4396), 1e-3);
  EXPECT_NEAR(red[1], std::sqrt(0.0898), 1e-3);
  EXPECT_NEAR(red[2], std::sqrt(0.0175), 2e-3);
}

TEST_F(Display, RefusesAConfigThatCannotSayWhatRec709Is) {
  const WithConfig config(write_config(foreign_config("", "Log", kSquareRoot)));
  EXPECT_NE(error_of<InputError>([] {
              shown({{0, 0, 0}}, "");
            }).find("expected a colour space"),
            std::string::npos);
}

TEST_F(Display, RefusesAViewWhoseTableIsMissing) {
  const std::string missing = "!<FileTransform> {src: no-such-table.cube}";
  const WithConfig config(write_config(foreign_config("", "lin_rec709", missing)));
  EXPECT_NE(error_of<InputError>([] {
              shown({{0, 0, 0}}, "");
            }).find("no-such-table.cube"),
            std::string::npos);
}

}  // namespace
}  // namespace parian
