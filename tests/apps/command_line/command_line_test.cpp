// `parian` as a user runs it: exit codes, one line of error, nothing left behind; pictures that do not depend
// on how they came about.
#include <gtest/gtest.h>

#include <csignal>

#include "tests/apps/command_line/support/program.h"

namespace parian {
namespace {

class CommandLine : public ProgramTest {
 protected:
  /// Runs what must fail: by its code, with one line on stderr that holds `names`, and no file written or
  /// left.
  void expect_refused(int code, const std::vector<std::string>& arguments, const std::string& names) {
    const std::set<std::string> before = files();
    const Outcome outcome = run(arguments);
    std::string command;
    for (const std::string& a : arguments) command += a + " ";
    EXPECT_EQ(outcome.code, code) << command << "\n" << outcome.err;
    EXPECT_EQ(std::ranges::count(outcome.err, '\n'), 1) << command << "\n" << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("parian: ") && outcome.err.ends_with("\n")) << command << "\n"
                                                                                    << outcome.err;
    EXPECT_NE(outcome.err.find(names), std::string::npos) << command << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << command;
    EXPECT_EQ(files(), before) << command;
  }

  std::vector<std::string> render_arguments(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"render", triangle, "-o", work("out.exr")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  Picture rendered(const std::string& name, const std::vector<std::string>& more, int code = 0) {
    std::vector<std::string> arguments{"render", triangle, "-o", work(name), "--size", "40x30", "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return read_picture(work(name));
  }
};

// Caught: an exit code of CLI11's own (105 and the like), its two lines of message, notes before the error.
TEST_F(CommandLine, BadUsageIsTwo) {
  expect_refused(2, {}, "subcommand");
  expect_refused(2, {"paint"}, "paint");
  expect_refused(2, {"render"}, "SCENE");
  expect_refused(2, {"render", triangle}, "-o");
  expect_refused(2, render_arguments({"--bogus"}), "--bogus");
  expect_refused(2, render_arguments({"--integrator", "photon"}), "photon");
  expect_refused(2, render_arguments({"--display", work("x.png"), "--view", "Sepia"}), "Sepia");
  expect_refused(2, render_arguments({"--camera", "west"}), "west");
  expect_refused(2, render_arguments({"--camera", "7"}), "7");
  expect_refused(2, render_arguments({"--sampler", "halton"}), "halton");
  expect_refused(2, render_arguments({"--filter", "gauss"}), "gauss");
  expect_refused(2, render_arguments({"--strategy", "both"}), "both");
  expect_refused(2, render_arguments({"--light-choice", "nearest"}), "nearest");
  expect_refused(2, render_arguments({"--aov", "velocity"}), "velocity");
  expect_refused(2, {"render", triangle, "-o", work("out.png")}, "out.png");
  expect_refused(2, {"render", triangle, "-o", work("out")}, "out");
  expect_refused(2, {"render", triangle, "--display", work("out.gif")}, "out.gif");
}

TEST_F(CommandLine, BadNumbersAreTwo) {
  for (const char* spp : {"0", "-1", "many", "1e3", "99999999999"})
    expect_refused(2, render_arguments({"--spp", spp}), "--spp");
  for (const char* size :
       {"0x5", "5x0", "-1x5", "70000x1", "1x70000", "junk", "5", "5x", "5x5x5", "x5", "5x5 6", "1e2x3"})
    expect_refused(2, render_arguments({"--size", size}), "--size");
  for (const char* threads : {"0", "-3", "two"})
    expect_refused(2, render_arguments({"--threads", threads}), "--threads");
  for (const char* seconds : {"0", "-1", "nan", "inf"})
    expect_refused(2, render_arguments({"--time", seconds}), "--time");
  for (const char* noise : {"0", "-1", "nan", "5%"})
    expect_refused(2, render_arguments({"--noise", noise}), "--noise");
  for (const char* tiles : {"0", "-4", "diagonal", "16x16", "70000", ""})
    expect_refused(2, render_arguments({"--tiles", tiles}), "--tiles");
  expect_refused(2, render_arguments({"--partitioner", "fair"}), "fair");
  expect_refused(2, render_arguments({"--max-depth", "-1"}), "--max-depth");
  for (const char* clamp : {"0", "-1", "nan"})
    expect_refused(2, render_arguments({"--clamp", clamp}), "--clamp");
  expect_refused(2, render_arguments({"--seed", "-1"}), "--seed");
  for (const char* at : {"-1", "nan", "soon"}) expect_refused(2, render_arguments({"--at", at}), "--at");
  expect_refused(2, render_arguments({"--exposure", "nan"}), "--exposure");
}

TEST_F(CommandLine, BadInputIsThree) {
  expect_refused(3, {"render", work("none.gltf"), "-o", work("out.exr")}, "none.gltf");
  expect_refused(3, {"info", work("none.gltf")}, "none.gltf");
  expect_refused(3, {"display", work("none.exr"), work("out.png")}, "none.exr");
  const std::string whole = read_bytes(triangle);
  for (const std::size_t size :
       {std::size_t(0), std::size_t(3), std::size_t(12), whole.size() / 2, whole.size() - 1}) {
    write("work/cut.glb", whole.substr(0, size));
    expect_refused(3, {"render", work("cut.glb"), "-o", work("out.exr")}, "cut.glb");
  }
  write("work/broken.gltf", R"({"asset": {"version": "2.0"}, "nodes": [)");
  expect_refused(3, {"render", work("broken.gltf"), "-o", work("out.exr")}, "broken.gltf");
  expect_refused(3, {"info", work("broken.gltf")}, "broken.gltf");
  expect_refused(3, render_arguments({"--env", work("sky.hdr")}), "sky.hdr");
  write("work/broken.exr", "v/1\x01");
  expect_refused(3, render_arguments({"--env", work("broken.exr")}), "broken.exr");
  expect_refused(3, {"display", work("broken.exr"), work("out.png")}, "broken.exr");
  expect_refused(3, render_arguments({"--resume", work("none.ckpt")}), "none.ckpt");
  write("work/junk.ckpt", std::string(1000, 'x'));
  expect_refused(3, render_arguments({"--resume", work("junk.ckpt")}), "junk.ckpt");
}

TEST_F(CommandLine, OutputsThatCannotBeWrittenAreThree) {
  expect_refused(3, {"render", triangle, "-o", work("nowhere/out.exr")}, "nowhere/out.exr");
  expect_refused(3, render_arguments({"--display", work("nowhere/out.png")}), "nowhere/out.png");
  expect_refused(3, render_arguments({"--stats", work("nowhere/stats.json")}), "nowhere/stats.json");
  expect_refused(3, render_arguments({"--checkpoint", work("nowhere/c")}), "nowhere/c");
  std::filesystem::create_directories(work("folder.exr"));
  expect_refused(3, {"render", triangle, "-o", work("folder.exr")}, "folder.exr");
}

TEST_F(CommandLine, HelpAndVersion) {
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"render", "--help"}, {"--version"}}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out, "");
    EXPECT_EQ(outcome.err, "");
  }
}

TEST_F(CommandLine, InfoDescribesTheScene) {
  const Outcome outcome = run({"info", triangle});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("triangle"), std::string::npos) << outcome.out;
}

// Caught: an option that is read and forgotten.
TEST_F(CommandLine, AtPosesTheScene) {
  GltfBuilder builder;
  builder.add_triangle();
  builder.root["nodes"] = {{{"mesh", 0}}};
  json animation;
  animation["samplers"] = {{{"input", builder.add<float>({0, 1}, "SCALAR")},
                            {"output", builder.add<float>({0, 0, 0, 0, 2, 0}, "VEC3")}}};
  animation["channels"] = {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}};
  builder.root["animations"] = {animation};
  write("work/moves.glb", builder.glb());
  const std::string rest = run({"info", work("moves.glb")}).out;
  EXPECT_NE(rest.find("around (0.5, 0.5, 0)"), std::string::npos) << rest;
  const std::string later = run({"info", work("moves.glb"), "--at", "0.75"}).out;
  EXPECT_NE(later.find("around (0.5, 2, 0)"), std::string::npos) << later;
  const auto picture = [&](const char* name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", triangle, work("moves.glb"), "-o", work(name),
                                       "--size", "40x30",  "--spp",           "4",  "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).code, 0);
    return read_picture(work(name)).pixels;
  };
  EXPECT_NE(picture("a.exr", {}), picture("b.exr", {"--at", "0.75"}));
}

TEST_F(CommandLine, DisplayMakesAPicture) {
  rendered("a.exr", {"--spp", "1"});
  const Outcome outcome = run({"display", work("a.exr"), work("a.png")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Picture p = read_picture(work("a.png"));
  EXPECT_EQ(p.width, 40);
  EXPECT_EQ(p.height, 30);
  expect_refused(2, {"display", work("a.exr"), work("b.png"), "--view", "Sepia"}, "Sepia");
  expect_refused(3, {"display", work("a.exr"), work("nowhere/b.png")}, "nowhere/b.png");
}

TEST_F(CommandLine, RenderLeavesItsPicturesAndNothingElse) {
  std::set<std::string> expected = files();
  rendered("a.exr", {"--spp", "2", "--display", work("a.png"), "--stats", work("a.json")});
  expected.insert({work("a.exr"), work("a.png"), work("a.json")});
  EXPECT_EQ(files(), expected);
}

// Notes and progress are on stderr, and none of it when quiet.
TEST_F(CommandLine, SaysWhatItAdded) {
  const Outcome outcome = run(render_arguments({"--size", "8x8", "--spp", "1"}));
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("no camera in the scene"), std::string::npos);
  EXPECT_NE(outcome.err.find("no light in the scene"), std::string::npos);
}

TEST_F(CommandLine, PicturesDoNotDependOnThreads) {
  const Picture one = rendered(
      "one.exr", {"--spp", "9", "--threads", "1", "--aov", "variance,samples,albedo,normal,depth,object"});
  const Picture two = rendered(
      "two.exr", {"--spp", "9", "--threads", "2", "--aov", "variance,samples,albedo,normal,depth,object"});
  EXPECT_EQ(one.channels.size(), 3u + 3 + 1 + 8);
  EXPECT_EQ(one.channels, two.channels);
  EXPECT_EQ(one.pixels, two.pixels);
  EXPECT_NE(rendered("three.exr", {"--spp", "9", "--seed", "1"}).pixels,
            rendered("four.exr", {"--spp", "9"}).pixels);
}

// Caught: a resume that draws samples again, a checkpoint written before the last pass.
TEST_F(CommandLine, ResumingGivesTheSamePicture) {
  const Picture whole = rendered("whole.exr", {"--spp", "20"});
  rendered("part.exr", {"--spp", "7", "--checkpoint", work("c")});
  const Picture resumed = rendered("resumed.exr", {"--spp", "20", "--resume", work("c")});
  EXPECT_EQ(resumed.channels, whole.channels);
  EXPECT_EQ(resumed.pixels, whole.pixels);
  EXPECT_EQ(resumed.metadata.at("parian:spp"), "20");
  // A checkpoint of other settings, or of another scene, is refused.
  std::filesystem::remove(work("out.exr"));
  expect_refused(3, render_arguments({"--size", "40x30", "--seed", "1", "--resume", work("c"), "--quiet"}),
                 work("c"));
  expect_refused(3, render_arguments({"--size", "41x30", "--resume", work("c"), "--quiet"}), work("c"));
  expect_refused(3, render_arguments({"--size", "40x30", "--at", "1", "--resume", work("c"), "--quiet"}),
                 work("c"));
  expect_refused(
      3, render_arguments({"--size", "40x30", "--light-choice", "power", "--resume", work("c"), "--quiet"}),
      work("c"));
  const std::string bytes = read_bytes(work("c"));
  write("work/cut", bytes.substr(0, bytes.size() / 2));
  expect_refused(3, render_arguments({"--size", "40x30", "--resume", work("cut"), "--quiet"}), work("cut"));
}

// Caught: an option that is read and forgotten, two names for one choice, another default.
TEST_F(CommandLine, LightsAreChosenAsAskedFor) {
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{
        "render", PARIAN_SOURCE_DIR "/scenes/lights/lights.gltf", "-o", work("a.exr"), "--size", "48x32",
        "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).code, 0);
    return read_picture(work("a.exr")).pixels;
  };
  const auto tree = with({"--spp", "4", "--light-choice", "tree"}),
             power = with({"--spp", "4", "--light-choice", "power"}),
             uniform = with({"--spp", "4", "--light-choice", "uniform"});
  EXPECT_EQ(with({"--spp", "4"}), tree);
  EXPECT_NE(power, tree);
  EXPECT_NE(uniform, tree);
  EXPECT_NE(uniform, power);
}

// Caught: an exit code of 130, a lost picture, a temporary left behind.
TEST_F(CommandLine, InterruptionSavesWhatIsThere) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::set<std::string> before = files();
    const auto program = start({"render", triangle, "-o", work("long.exr"), "--size", "64x48", "--spp",
                                "100000000", "--checkpoint", work("c"), "--quiet"});
    ASSERT_TRUE(program->wait_for_handler(signal));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    program->send(signal);
    const Outcome outcome = program->finish();
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    const Picture p = read_picture(work("long.exr"));
    EXPECT_EQ(p.width, 64);
    double sum = 0;
    for (const float c : p.pixels) sum += c;
    EXPECT_GT(sum, 0);
    EXPECT_GT(std::stoul(p.metadata.at("parian:spp")), 0u);
    std::set<std::string> expected = before;
    expected.insert({work("long.exr"), work("c")});
    EXPECT_EQ(files(), expected);
    // The checkpoint of an interruption can be gone on from.
    const Outcome again =
        run({"render", triangle, "-o", work("long.exr"), "--size", "64x48", "--spp",
             std::to_string(std::stoul(p.metadata.at("parian:spp")) + 1), "--resume", work("c"), "--quiet"});
    EXPECT_EQ(again.code, 0) << again.err;
    std::filesystem::remove(work("long.exr"));
    std::filesystem::remove(work("c"));
  }
}

TEST_F(CommandLine, TimeLimitEndsTheRender) {
  const auto start_time = std::chrono::steady_clock::now();
  const Picture p = rendered("timed.exr", {"--time", "0.5"});
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start_time).count(), 20);
  EXPECT_GT(std::stoul(p.metadata.at("parian:spp")), 0u);
}

// Of the ends that are given, the first that is reached counts; --noise alone has no other.
TEST_F(CommandLine, NoiseEndsTheRender) {
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",  PARIAN_SOURCE_DIR "/scenes/light-disk/light-disk.gltf",
                                       "-o",      work("a.exr"),
                                       "--size",  "64x64",
                                       "--aov",   "samples",
                                       "--stats", work("a.json"),
                                       "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(run(arguments).code, 0);
    return json::parse(read_bytes(work("a.json")));
  };
  json stats = render({"--noise", ".01"});
  EXPECT_LE(stats["noise"]["bound"].get<double>(), .01);
  EXPECT_GE(stats["noise"]["bound"].get<double>(), .005);
  EXPECT_LE(stats["noise"]["estimate"], stats["noise"]["bound"]);
  EXPECT_GE(stats["least_samples_per_pixel"], 16);
  EXPECT_GT(stats["samples_per_pixel"], stats["least_samples_per_pixel"]);
  const Picture p = read_picture(work("a.exr"));
  EXPECT_EQ(p.channels.back(), "samples");
  EXPECT_EQ(p.metadata.at("parian:noise"), fmt::format("{:.4g}", stats["noise"]["bound"].get<double>()));
  stats = render({"--noise", "1e-5", "--spp", "32"});
  EXPECT_NEAR(stats["samples_per_pixel"].get<double>(), 32, 5);
  stats = render({"--noise", "1e-5", "--time", ".5"});
  EXPECT_NEAR(stats["seconds"]["render"].get<double>(), .5, .2);
  stats = render({"--time", "100", "--spp", "5"});
  EXPECT_EQ(stats["samples_per_pixel"], 5);
}

TEST_F(CommandLine, TilesAndPartitionersChangeNoBit) {
  const auto pixels = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"--spp", "4"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return rendered("a.exr", arguments).pixels;
  };
  const auto expected = pixels({});
  for (const char* tiles : {"rows", "columns", "8", "1000"}) EXPECT_EQ(pixels({"--tiles", tiles}), expected);
  for (const char* partitioner : {"auto", "static", "simple", "affinity"})
    EXPECT_EQ(pixels({"--partitioner", partitioner}), expected);
}

TEST_F(CommandLine, StatisticsAddUp) {
  rendered("a.exr", {"--spp", "6", "--threads", "2", "--stats", work("a.json")});
  const json stats = json::parse(read_bytes(work("a.json")));
  const double camera = stats["rays"]["camera"], scattered = stats["rays"]["scattered"],
               shadow = stats["rays"]["shadow"];
  EXPECT_EQ(camera, 40 * 30 * 6);
  EXPECT_GT(scattered, 0);
  EXPECT_GT(shadow, 0);
  EXPECT_NEAR(stats["rays_per_camera_path"].get<double>(), (camera + scattered + shadow) / camera, 1e-9);
  EXPECT_EQ(stats["samples_per_pixel"], 6);
  EXPECT_EQ(stats["threads"], 2);
  EXPECT_EQ(stats["triangles"], 1);
  EXPECT_EQ(stats["solids"], 0);
  EXPECT_EQ(stats["dropped_samples"], 0);
  EXPECT_GT(stats["peak_memory_bytes"].get<double>(), 1e6);
  EXPECT_GT(stats["acceleration_bytes"].get<double>(), 0);
  for (const char* phase : {"load", "build", "render", "write"})
    EXPECT_GE(stats["seconds"][phase].get<double>(), 0) << phase;
  const double cpu = stats["render_cpu_seconds"];
  EXPECT_NEAR(stats["camera_paths_per_cpu_second"].get<double>() * cpu, camera, 1e-3 * camera);
}

TEST_F(CommandLine, TheFileSaysHowItWasMade) {
  const Picture p = rendered("a.exr", {"--spp", "3", "--seed", "17", "--integrator", "ao"});
  EXPECT_EQ(p.metadata.at("parian:scene"), triangle);
  EXPECT_EQ(p.metadata.at("parian:integrator"), "ao");
  EXPECT_EQ(p.metadata.at("parian:spp"), "3");
  EXPECT_EQ(p.metadata.at("parian:seed"), "17");
  EXPECT_FALSE(p.metadata.at("parian:version").empty());
  EXPECT_TRUE(p.metadata.contains("parian:renderSeconds"));
}

TEST_F(CommandLine, LayersAreThoseAskedFor) {
  EXPECT_EQ(rendered("a.exr", {"--spp", "1", "--aov", "none"}).channels,
            (std::vector<std::string>{"R", "G", "B"}));
  const Picture p = rendered("b.exr", {"--spp", "1", "--aov", "depth"});
  EXPECT_EQ(p.channels.size(), 4u);
  EXPECT_NE(std::ranges::find(p.channels, "depth.Z"), p.channels.end());
}

// Two scenes on one command line are one.
TEST_F(CommandLine, ScenesAreComposed) {
  write("work/second.glb", read_bytes(triangle));
  const Outcome outcome = run({"render", triangle, work("second.glb"), "-o", work("both.exr"), "--size",
                               "8x8", "--spp", "1", "--stats", work("s.json"), "--quiet"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json::parse(read_bytes(work("s.json")))["triangles"], 2);
}

}  // namespace
}  // namespace parian
