// --build and --memory, and what is predicted of the memory.
#include "tests/apps/command_line/support/program.h"

namespace parian {
namespace {

class BuildOptions : public ProgramTest {
 protected:
  void SetUp() override {
    ProgramTest::SetUp();
    constexpr std::uint32_t kSide =
        1100;  // squares of two triangles: more than what writes the picture takes
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t y = 0; y <= kSide; ++y)
      for (std::uint32_t x = 0; x <= kSide; ++x)
        positions.insert(positions.end(),
                         {float(x) / kSide, float(y) / kSide, 0.1f * std::sin(float(x * y) * 1e-4f)});
    for (std::uint32_t y = 0; y < kSide; ++y)
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const std::uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
        indices.insert(indices.end(), {a, a + 1, b + 1, b + 1, b, a});
      }
    GltfBuilder builder;
    json& mesh = builder.add_mesh({{"POSITION", builder.add(positions, "VEC3")}});
    mesh["indices"] = builder.add(indices, "SCALAR");
    builder.root["nodes"] = {{{"mesh", 0}}};
    builder.root["scenes"] = {{{"nodes", {0}}}};
    builder.root["scene"] = 0;
    grid_ = write("work/grid.glb", builder.glb());
  }

  Outcome render(const std::vector<std::string>& more, const std::string& spp = "4") {
    std::vector<std::string> arguments{"render",          grid_,   "-o", work("out.exr"), "--size",
                                       "32x32",           "--spp", spp,  "--quiet",       "--stats",
                                       work("stats.json")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  json statistics() const { return json::parse(read_bytes(work("stats.json"))); }

  std::string grid_;
};

// Caught: an option that does nothing.
TEST_F(BuildOptions, BuildIsAsAskedForAndThePictureTheSame) {
  std::vector<double> means, bytes;
  for (const std::string build : {"fast", "balanced", "best"}) {
    ASSERT_EQ(render({"--build", build}).code, 0);
    const json stats = statistics();
    EXPECT_EQ(stats["build"], build);
    EXPECT_EQ(stats["compact"], false);
    bytes.push_back(stats["acceleration_bytes"]);
    const Picture picture = read_picture(work("out.exr"));
    double sum = 0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += picture.channels.size()) sum += picture.pixels[i];
    means.push_back(sum);
  }
  EXPECT_NEAR(means[1] / means[0], 1, 1e-3);
  EXPECT_NEAR(means[2] / means[0], 1, 1e-3);
  EXPECT_GT(bytes[0], 1.1 * bytes[1]);
  // By default quick, for so few rays.
  ASSERT_EQ(render({}).code, 0);
  EXPECT_EQ(statistics()["build"], "fast");
  ASSERT_EQ(render({}, "300").code, 0);
  EXPECT_EQ(statistics()["build"], "balanced");
}

// Within 10%, and told before. Caught: the process itself left out.
TEST_F(BuildOptions, PeakMemoryIsPredicted) {
  ASSERT_EQ(render({"--build", "balanced"}).code, 0);
  const json stats = statistics();
  const double peak = stats["peak_memory_bytes"], predicted = stats["predicted_peak_memory_bytes"];
  EXPECT_NEAR(predicted / peak, 1, 0.1);
  const Outcome info = run({"info", grid_, "--size", "32x32"});
  ASSERT_EQ(info.code, 0);
  double said = 0;
  const std::size_t at = info.out.find("rendering ");
  ASSERT_NE(at, std::string::npos) << info.out;
  ASSERT_EQ(std::sscanf(info.out.c_str() + at, "rendering about %lf MB", &said), 1) << info.out;
  EXPECT_NEAR(said * 1e6 / peak, 1, 0.1);
}

// Caught: compact left out, a limit that nobody asks about.
TEST_F(BuildOptions, StaysBelowTheLimitOrSaysWhatItNeeds) {
  ASSERT_EQ(render({"--build", "balanced"}).code, 0);
  const double predicted = statistics()["predicted_peak_memory_bytes"];
  // Too little for all but the compact structure.
  ASSERT_EQ(render({"--memory", std::to_string(long(predicted - 20e6))}).code, 0);
  EXPECT_EQ(statistics()["compact"], true);
  EXPECT_LT(statistics()["acceleration_bytes"].get<double>(), 110e6);

  std::filesystem::remove(work("out.exr"));
  std::filesystem::remove(work("stats.json"));
  const std::set<std::string> before = files();
  for (const std::string& limit : {std::to_string(long(predicted - 86e6)), std::string("1M")}) {
    const Outcome outcome = render({"--memory", limit});
    EXPECT_EQ(outcome.code, 3) << limit;
    EXPECT_TRUE(outcome.err.find("not enough memory: ") != std::string::npos) << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << outcome.err;
    EXPECT_EQ(files(), before);
  }
  EXPECT_EQ(render({"--memory", "none"}).code, 2);
  EXPECT_EQ(render({"--build", "quick"}).code, 2);
}

}  // namespace
}  // namespace parian
