// `parian compare` as a user runs it: numbers, exit codes, one line of error, files whole or not at all.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/apps/command_line/support/program.h"

namespace parian {
namespace {

using Names = std::vector<std::string>;

/// value(x, y, channel) for each pixel.
Picture make_picture(const Names& channels, int width, int height,
                     const std::function<float(int, int, int)>& value) {
  Picture p{width, height, channels, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < int(channels.size()); ++c) p.pixels.push_back(value(x, y, c));
  return p;
}

Picture grey(float value, const Names& channels = {"R", "G", "B"}, int width = 40, int height = 30) {
  return make_picture(channels, width, height, [=](int, int, int) { return value; });
}

class CompareCommand : public ProgramTest {
 protected:
  std::string save(const std::string& name, const Picture& picture) const {
    (name.ends_with(".exr") ? write_exr : write_display_image)(picture, work(name));
    return work(name);
  }

  Outcome compare(const Names& arguments) {
    Names all{"compare"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return run(all);
  }

  /// The JSON of a comparison that ends with `code`.
  json numbers(Names arguments, int code = 0) {
    arguments.insert(arguments.end(), {"--json", work("numbers.json")});
    const Outcome outcome = compare(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.out << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return json::parse(read_bytes(work("numbers.json")));
  }

  /// Runs what must fail, with one line on stderr that holds `names`, and no file written or left.
  void expect_refused(int code, Names arguments, const std::string& names) {
    arguments.insert(arguments.end(), {"--json", work("out.json"), "--heat-map", work("out.png")});
    const std::set<std::string> before = files();
    const Outcome outcome = compare(arguments);
    EXPECT_EQ(outcome.code, code) << names << "\n" << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("parian: ")) << outcome.err;
    EXPECT_NE(outcome.err.find(names), std::string::npos) << names << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(files(), before);
  }
};

TEST_F(CompareCommand, NumbersAreThoseOfTheFormulas) {
  const std::string reference = save("r.exr", grey(0.5f));
  Picture p = grey(0.6f);
  p.at(7, 3)[1] = 0;
  const json all = numbers({save("t.exr", p), reference});
  EXPECT_EQ(all["width"], 40);
  EXPECT_EQ(all["height"], 30);
  const json& layer = all["layers"]["rgb"];
  const double pixels = 1200, square = (0.01 * (3 * pixels - 1) + 0.25) / (3 * pixels);
  EXPECT_NEAR(layer["rmse"], std::sqrt(square), 1e-6);
  EXPECT_NEAR(layer["relmse"], square / 0.26, 1e-6);
  EXPECT_NEAR(layer["psnr"], -10 * std::log10(square), 1e-4);
  EXPECT_NEAR(layer["channels"]["R"]["mean"], 0.1, 1e-6);
  EXPECT_NEAR(layer["channels"]["G"]["mean"], (0.1 * (pixels - 1) - 0.5) / pixels, 1e-6);
  EXPECT_NEAR(layer["channels"]["G"]["mean_absolute"], (0.1 * (pixels - 1) + 0.5) / pixels, 1e-6);
  EXPECT_EQ(layer["largest"]["difference"], 0.5);
  EXPECT_EQ(layer["largest"]["channel"], "G");
  EXPECT_EQ(layer["largest"]["x"], 7);
  EXPECT_EQ(layer["largest"]["y"], 3);
  EXPECT_GT(all["flip"]["ldr"], 0.01);
  EXPECT_GT(all["flip"]["hdr"], 0.01);
  EXPECT_FALSE(all.contains("means"));
  EXPECT_NEAR(numbers({work("t.exr"), reference, "--peak", "10"})["layers"]["rgb"]["psnr"].get<double>(),
              layer["psnr"].get<double>() + 20, 1e-6);
}

TEST_F(CompareCommand, APictureIsLikeItself) {
  const std::string picture = save(
      "a.exr", grey(0.5f, {"R", "G", "B", "variance.R", "variance.G", "variance.B", "albedo.R", "depth.Z"}));
  const json all = numbers({picture, picture, "--max-rmse", "0", "--max-relmse", "0", "--min-psnr", "1000",
                            "--max-difference", "0", "--max-mean-difference", "0", "--max-flip", "0",
                            "--max-hdr-flip", "0", "--same-means", "--heat-map", work("map.png")});
  EXPECT_EQ(all["layers"].size(), 3u);
  EXPECT_EQ(all["layers"]["rgb"]["rmse"], 0);
  EXPECT_TRUE(all["layers"]["rgb"]["psnr"].is_null());
  EXPECT_EQ(all["flip"]["ldr"], 0);
  EXPECT_EQ(all["means"]["agree"], true);
  EXPECT_EQ(all["means"]["variance"], "both");
  EXPECT_EQ(all["exceeded"].size(), 0u);
  EXPECT_LT(read_picture(work("map.png")).at(5, 5)[0], 0.01f);
}

// Each limit is read, is held against its own number, and alone decides.
TEST_F(CompareCommand, LimitsDecideTheExitCode) {
  const std::string t = save("t.exr", grey(0.6f)), r = save("r.exr", grey(0.5f));
  const Names within{t,
                     r,
                     "--max-rmse",
                     "0.11",
                     "--max-relmse",
                     "0.04",
                     "--min-psnr",
                     "19",
                     "--max-difference",
                     "0.11",
                     "--max-mean-difference",
                     "0.11",
                     "--max-flip",
                     "0.9",
                     "--max-hdr-flip",
                     "0.9"};
  EXPECT_EQ(numbers(within)["exceeded"].size(), 0u);
  const Names too_low{"0.09", "0.03", "21", "0.09", "0.09", "0.001", "0.001"};
  const Names number{"RMSE", "relMSE", "PSNR", "largest difference", "mean difference", "FLIP", "HDR FLIP"};
  Names exceeding = within;
  for (std::size_t i = 0; i < too_low.size(); ++i) exceeding[3 + 2 * i] = too_low[i];
  const json exceeded = numbers(exceeding, 1)["exceeded"];
  ASSERT_EQ(exceeded.size(), number.size());
  for (std::size_t i = 0; i < number.size(); ++i) EXPECT_EQ(exceeded[i]["number"], number[i]);
  const Outcome outcome = compare({t, r, "--max-rmse", "0.09", "--min-psnr", "19"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_NE(outcome.out.find("exceeded   RMSE of rgb: 0.1, limit 0.09, by 0.01"), std::string::npos)
      << outcome.out;
  EXPECT_EQ(outcome.out.find("PSNR of"), std::string::npos) << outcome.out;
}

// A mean of 1200 pixels, or of their layer alone, must not hide it.
TEST_F(CompareCommand, WhatIsNotFiniteExceedsEveryLimit) {
  const Names channels{"R", "G", "B", "depth.Z"};
  const std::string good = save("good.exr", grey(0.5f, channels));
  const auto expect_found = [&](const std::string& test, const std::string& reference, const char* layer) {
    const json all = numbers(
        {test, reference, "--max-rmse", "9", "--max-relmse", "9", "--min-psnr", "-99", "--max-difference",
         "9", "--max-mean-difference", "9", "--max-flip", "1", "--max-hdr-flip", "1"},
        1);
    EXPECT_EQ(all["exceeded"].size(), 2u * 4 + 1 + 2);
    EXPECT_EQ(all["layers"][layer]["not_finite"]["pixels"], 1);
    EXPECT_TRUE(all["layers"][layer]["rmse"].is_null());
    EXPECT_EQ(all["layers"][layer]["largest"]["x"], 3);
    EXPECT_EQ(all["layers"][layer]["largest"]["y"], 4);
  };
  for (const float value : {NAN, INFINITY}) {
    Picture p = grey(0.5f, channels);
    p.at(3, 4)[1] = value;
    const std::string bad = save("bad.exr", p);
    expect_found(bad, good, "rgb");
    expect_found(good, bad, "rgb");
    expect_found(bad, bad, "rgb");
    const Outcome outcome = compare({bad, good, "--max-flip", "1"});
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.out.find("FLIP: cannot be within 1, since values are not finite"), std::string::npos);
    EXPECT_NE(outcome.out.find("FLIP       nan; nan"), std::string::npos) << outcome.out;
  }
  Picture p = grey(0.5f, channels);
  p.at(3, 4)[3] = NAN;
  expect_found(save("deep.exr", p), good, "depth");
}

TEST_F(CompareCommand, MeansAreComparedByTheVariance) {
  const Names channels{"R", "G", "B", "variance.R", "variance.G", "variance.B"};
  const auto make = [&](float value) {
    return make_picture(channels, 256, 256, [=](int, int, int c) { return c < 3 ? value : 0.01f; });
  };
  const std::string r = save("r.exr", make(0.5f)),
                    bare = save("bare.exr", grey(0.5f, {"R", "G", "B"}, 256, 256));
  const json all = numbers({save("t.exr", make(0.505f)), r, "--same-means"}, 1);
  EXPECT_EQ(all["means"]["scores"].size(), 51u);
  EXPECT_NEAR(all["means"]["worst"], 0.005 * 256 / std::sqrt(0.02), 1e-2);
  numbers({save("near.exr", make(0.5005f)), r, "--same-means"});
  EXPECT_EQ(numbers({bare, r, "--same-means"})["means"]["variance"], "reference");
  EXPECT_EQ(numbers({r, bare, "--same-means"})["means"]["variance"], "test");
  expect_refused(3, {bare, bare, "--same-means"}, "variance");
}

TEST_F(CompareCommand, OneLayerAlone) {
  Picture p = grey(0.5f, {"R", "G", "B", "albedo.R", "depth.Z"});
  const std::string r = save("r.exr", p);
  p.at(0, 0)[3] = 0;
  const std::string t = save("t.exr", p), colors = save("colors.exr", grey(0.5f));
  const json albedo =
      numbers({t, r, "--layer", "albedo", "--max-difference", "0.1", "--heat-map", work("map.png")}, 1);
  EXPECT_EQ(albedo["layers"].size(), 1u);
  EXPECT_FALSE(albedo.contains("flip"));
  EXPECT_FALSE(albedo["layers"]["albedo"].contains("psnr"));
  numbers({t, r, "--layer", "rgb", "--max-difference", "0"});
  numbers({t, colors, "--layer", "rgb", "--max-difference", "0"});
  std::filesystem::remove(work("map.png"));
  expect_refused(3, {t, colors}, "colors.exr: has no albedo, depth");
  expect_refused(3, {colors, t}, "--layer");
  expect_refused(3, {t, colors, "--layer", "depth"}, "colors.exr");
  expect_refused(2, {t, r, "--layer", "velocity"}, "velocity");
  for (const char* option : {"--max-flip", "--max-hdr-flip", "--min-psnr"})
    expect_refused(2, {t, r, "--layer", "depth", option, "1"}, option);
  expect_refused(2, {t, r, "--layer", "depth", "--same-means"}, "--same-means");
  expect_refused(2, {t, r, "--layer", "depth", "--heat-map-of", "flip"}, "--heat-map-of");
}

TEST_F(CompareCommand, PicturesForTheScreenAreDecodedForFlipAlone) {
  const std::string t = save("t.png", grey(0.6f)), r = save("r.png", grey(0.4f));
  const json all = numbers({t, r, "--max-flip", "0.9"});
  EXPECT_NEAR(all["layers"]["rgb"]["rmse"], 0.2, 1e-6);
  EXPECT_FALSE(all["flip"].contains("hdr"));
  // The same light in numbers that are not encoded.
  const json linear = numbers({save("t.exr", grey(0.318547f)), save("r.exr", grey(0.132868f))});
  EXPECT_NEAR(all["flip"]["ldr"], linear["flip"]["ldr"].get<double>(), 1e-4);
  expect_refused(3, {t, r, "--max-hdr-flip", "0.5"}, "--max-hdr-flip");
  expect_refused(3, {t, r, "--heat-map-of", "hdr-flip"}, "hdr-flip");
}

TEST_F(CompareCommand, HeatMapsShowWhatTheyAreAskedFor) {
  const auto patch = [](int x, int y, int) { return x > 15 && x < 25 && y > 5 && y < 15 ? 0 : 0.5f; };
  const std::string t = save("t.exr", make_picture({"R", "G", "B"}, 40, 30, patch)),
                    r = save("r.exr", grey(0.5f));
  std::set<std::vector<float>> maps;
  for (const char* name : {"flip", "hdr-flip", "error"}) {
    EXPECT_EQ(compare({t, r, "--heat-map", work("map.png"), "--heat-map-of", name}).code, 0);
    const Picture map = read_picture(work("map.png"));
    EXPECT_EQ(map.width, 40);
    EXPECT_GT(map.at(20, 10)[0], map.at(0, 29)[0] + 0.3f) << name;
    maps.insert(map.pixels);
  }
  EXPECT_EQ(maps.size(), 3u);
  EXPECT_EQ(compare({t, r, "--heat-map", work("map.png")}).code, 0);
  EXPECT_TRUE(maps.contains(read_picture(work("map.png")).pixels));
}

TEST_F(CompareCommand, BadUsageIsTwo) {
  const std::string t = save("t.exr", grey(0.5f));
  expect_refused(2, {}, "TEST");
  expect_refused(2, {t}, "REFERENCE");
  expect_refused(2, {t, t, "--max-brightness", "1"}, "--max-brightness");
  expect_refused(2, {t, t, "--heat-map-of", "ssim"}, "ssim");
  expect_refused(2, {t, t, "--max-rmse", "-1"}, "--max-rmse");
  expect_refused(2, {t, t, "--max-flip", "nan"}, "--max-flip");
  expect_refused(2, {t, t, "--max-difference", "many"}, "--max-difference");
  expect_refused(2, {t, t, "--ppd", "0"}, "--ppd");
  expect_refused(2, {t, t, "--significance", "1"}, "--significance");
  const Outcome alone = compare({t, t, "--heat-map-of", "flip"}),
                gif = compare({t, t, "--heat-map", work("a.gif")});
  EXPECT_EQ(alone.code, 2);
  EXPECT_EQ(gif.code, 2);
  EXPECT_FALSE(std::filesystem::exists(work("a.gif")));
}

TEST_F(CompareCommand, BadInputIsThree) {
  const std::string good = save("good.exr", grey(0.5f)), whole = read_bytes(good);
  expect_refused(3, {work("none.exr"), good}, "none.exr");
  expect_refused(3, {good, work("none.exr")}, "none.exr");
  write("work/text.exr", "no picture\n");
  expect_refused(3, {work("text.exr"), good}, "text.exr");
  for (const std::size_t size : {std::size_t(0), std::size_t(4), whole.size() / 2, whole.size() - 1}) {
    write("work/cut.exr", whole.substr(0, size));
    expect_refused(3, {work("cut.exr"), good}, "cut.exr");
    expect_refused(3, {good, work("cut.exr")}, "cut.exr");
  }
  expect_refused(3, {save("small.exr", grey(0.5f, {"R", "G", "B"}, 30, 40)), good},
                 "small.exr: 30 x 40 pixels; expected 40 x 30");
  expect_refused(3, {save("y.exr", grey(0.5f, {"Y"})), good}, "y.exr: channels Y; expected R, G, B");
  expect_refused(3, {save("a.exr", grey(0.5f, {"R", "G", "B", "A"})), good}, "a.exr: channels R, G, B, A");
  expect_refused(3, {save("screen.png", grey(0.5f)), good},
                 "screen.png: the values are sRGB; expected linear");
}

TEST_F(CompareCommand, OutputsThatCannotBeWrittenAreThree) {
  const std::string t = save("t.exr", grey(0.5f));
  const std::set<std::string> before = files();
  for (const char* option : {"--json", "--heat-map"}) {
    const Outcome outcome = compare({t, t, option, work("nowhere/out.png")});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find("nowhere/out.png"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_EQ(files(), before);
}

TEST_F(CompareCommand, DoesNotDependOnThreads) {
  const auto make = [](float scale) {
    return make_picture({"R", "G", "B"}, 50, 40,
                        [=](int x, int y, int c) { return scale * float((x * 7 + y * 13 + c) % 11) / 11; });
  };
  const Names files{save("t.exr", make(1.1f)), save("r.exr", make(1))};
  EXPECT_EQ(numbers({files[0], files[1], "--threads", "1"}), numbers({files[0], files[1], "--threads", "4"}));
}

}  // namespace
}  // namespace parian
