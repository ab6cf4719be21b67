// --texture-memory, as a user gives it.
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>

#include "tests/apps/command_line/support/program.h"

namespace parian {
namespace {

namespace fs = std::filesystem;

/// A scene of a quad with three large images that fills the picture, and a folder for temporary files.
class TextureMemory : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    fs::create_directories(path("tmp"));
    setenv("TMPDIR", path("tmp").c_str(), 1);
    GltfBuilder builder;
    json& quad =
        builder.add_mesh({{"POSITION", builder.add<float>({-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0}, "VEC3")},
                          {"TEXCOORD_0", builder.add<float>({0, 3, 3, 3, 3, 0, 0, 0}, "VEC2")}});
    quad["indices"] = builder.add<std::uint32_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
    quad["material"] = 0;
    json material = {{"pbrMetallicRoughness",
                      {{"baseColorTexture", {{"index", 0}}}, {"metallicRoughnessTexture", {{"index", 1}}}}},
                     {"emissiveFactor", {1, 1, 1}},
                     {"emissiveTexture", {{"index", 2}}}};
    builder.root["materials"] = json::array({std::move(material)});
    for (int i = 0; i < 3; ++i) {
      const std::string name = fmt::format("{}.exr", i);
      write_image(name, i);
      builder.root["images"].push_back({{"uri", name}});
      builder.root["textures"].push_back({{"source", i}});
    }
    builder.root["nodes"] = {{{"mesh", 0}}};
    builder.root["scenes"] = {{{"nodes", {0}}}};
    builder.root["scene"] = 0;
    scene_ = write("work/scene.glb", builder.glb());
  }
  void TearDown() override {
    unsetenv("TMPDIR");
    ProgramTest::TearDown();
  }

  /// 12 MiB, of a pattern that no tile has twice.
  void write_image(const std::string& name, int seed) const {
    constexpr int kSide = 1024;
    Picture picture{kSide, kSide, {"R", "G", "B"}, {}, {}};
    for (int i = 0; i < kSide * kSide; ++i)
      for (int c = 0; c < 3; ++c)
        picture.pixels.push_back(
            0.5f + 0.5f * std::sin(float(i / kSide * (c + 1) + (i % kSide) * (seed + 2)) * 0.01f));
    write_exr(picture, work(name));
  }

  std::vector<std::string> render(const std::string& output, const std::vector<std::string>& more,
                                  const std::string& spp = "4") const {
    std::vector<std::string> arguments{"render", scene_,  "-o", work(output), "--size",
                                       "96x96",  "--spp", spp,  "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  std::string scene_;
};

TEST_F(TextureMemory, ChangesNoBit) {
  ASSERT_EQ(run(render("free.exr", {"--stats", work("free.json")})).code, 0);
  const Picture free = read_picture(work("free.exr"));
  EXPECT_EQ(json::parse(read_bytes(work("free.json")))["images"]["memory_bytes"], 36 << 20);
  for (const std::string threads : {"1", "4"}) {
    const Outcome outcome = run(render(
        "capped.exr", {"--texture-memory", "26MiB", "--threads", threads, "--stats", work("capped.json")}));
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(read_picture(work("capped.exr")).pixels, free.pixels) << threads << " threads";
    const json images = json::parse(read_bytes(work("capped.json")))["images"];
    EXPECT_EQ(images["memory_bytes"], 12 << 20);
    EXPECT_EQ(images["file_bytes"], 24 << 20);
    EXPECT_EQ(images["cache_bytes"], 14 << 20);
    EXPECT_GT(images["tile_reads"], 500);
    EXPECT_LT(images["cache_peak_bytes"], 15 << 20);
  }
  EXPECT_TRUE(fs::is_empty(path("tmp")));
}

TEST_F(TextureMemory, InfoSaysWhatImagesTake) {
  const Outcome outcome = run({"info", scene_, "--texture-memory", "26MiB"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("12.6 MB images"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("25.2 MB images more, in a temporary file"), std::string::npos) << outcome.out;
}

TEST_F(TextureMemory, RefusesWhatIsTooLittle) {
  const std::set<std::string> before = files();
  const auto expect_refused = [&](int code, const std::vector<std::string>& more, const std::string& text) {
    const Outcome outcome = run(render("out.exr", more));
    EXPECT_EQ(outcome.code, code);
    EXPECT_NE(outcome.err.find(text), std::string::npos) << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_EQ(files(), before);
  };
  expect_refused(2, {"--texture-memory", "1M"}, "--texture-memory 1M: expected at least 16MiB");
  expect_refused(2, {"--texture-memory", "some"}, "--texture-memory some: expected a number");
  expect_refused(3, {"--texture-memory", "16MiB", "--env", work("0.exr")}, "environment maps leave");
  setenv("TMPDIR", path("absent").c_str(), 1);
  expect_refused(3, {"--texture-memory", "16MiB"}, path("absent") + ": no temporary file");
}

// Caught: a picture with black texels that looks like any other, a render that goes on for nothing.
TEST_F(TextureMemory, LostTexelsEndTheRender) {
  const std::set<std::string> before = files();
  auto program =
      start(render("out.exr", {"--texture-memory", "16MiB", "--checkpoint", work("state")}, "1000000"));
  bool is_loaded = false;
  for (int i = 0; i < 6 && !is_loaded; ++i) is_loaded = program->wait_for_handler(SIGTERM);
  ASSERT_TRUE(is_loaded);
  program->truncate_open_file(path("tmp"));
  const Outcome outcome = program->finish();
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.err, "parian: " + path("tmp") +
                             ": the temporary file for images cannot be read: it has become shorter\n");
  EXPECT_EQ(files(), before);
}

}  // namespace
}  // namespace parian
