// The scenes under scenes/, against what their expected.json says of their pictures; and models of others.
#include <gtest/gtest.h>

#include "integrators/integrators.h"
#include "renderer/session/session.h"
#include "tests/scene_io/support/gltf_builder.h"

namespace parian {
namespace {

namespace fs = std::filesystem;

Picture render(const Scene& scene, int width, int height, std::uint32_t spp,
               Subsurface subsurface = Subsurface::automatic) {
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.spp = spp;
  Session session(std::make_shared<const Scene>(scene), settings,
                  make_integrator("path", {.subsurface = subsurface}));
  session.start();
  session.wait();
  EXPECT_EQ(session.stats().rays.dropped, 0u);
  Picture picture = session.snapshot();
  for (const float value : picture.pixels) {
    if (std::isfinite(value) && value >= 0) continue;
    ADD_FAILURE() << "a value of " << value;
    break;
  }
  return picture;
}

/// Folders in scenes/ whose picture has values to compare, or has none.
std::vector<std::string> scenes(bool with_values) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(PARIAN_SOURCE_DIR "/scenes")) {
    if (!fs::exists(entry.path() / "expected.json")) continue;
    const json expected = json::parse(read_bytes(entry.path() / "expected.json"));
    if ((!expected["mean"].is_null() || expected.contains("pixels")) == with_values)
      names.push_back(entry.path().filename());
  }
  std::ranges::sort(names);
  return names;
}

Scene load(const std::string& name) {
  std::vector<std::string> warnings;
  const fs::path folder = fs::path(PARIAN_SOURCE_DIR "/scenes") / name;
  Scene scene = load_scene({folder / (name + ".gltf")}, {}, warnings);
  for (const std::string& warning : warnings) ADD_FAILURE() << name << ": " << warning;
  EXPECT_TRUE(add_missing_camera_and_light(scene).empty()) << name;
  return scene;
}

/// Means of a region, as fractions of the picture from its top left, against three values.
void expect_mean(const Picture& p, const std::array<double, 4>& region, const json& values, double tolerance,
                 const std::string& what) {
  const int x0 = int(std::lround(region[0] * p.width)), y0 = int(std::lround(region[1] * p.height)),
            x1 = int(std::lround(region[2] * p.width)), y1 = int(std::lround(region[3] * p.height));
  ASSERT_TRUE(x0 < x1 && y0 < y1) << what;
  for (int k = 0; k < 3; ++k) {
    double sum = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) sum += p.at(x, y)[k];
    const double value = values[std::size_t(k)];
    EXPECT_NEAR(sum / ((x1 - x0) * (y1 - y0)), value, tolerance * std::max(value, 1e-3))
        << what << ", channel " << k;
  }
}

/// The method that a scene's values are for, as `--sss` names it.
Subsurface subsurface_of(const json& expected) {
  const std::string name = expected.value("sss", "auto");
  if (name == "auto") return Subsurface::automatic;
  if (name == "random-walk") return Subsurface::random_walk;
  EXPECT_EQ(name, "dipole");
  return Subsurface::dipole;
}

/// Renders `name` and checks all that its expected.json says.
void check_scene(const std::string& name) {
  const json expected = json::parse(read_bytes(PARIAN_SOURCE_DIR "/scenes/" + name + "/expected.json"));
  const Picture p =
      render(load(name), expected["size"][0], expected["size"][1], expected["spp"], subsurface_of(expected));
  if (!expected["mean"].is_null())
    expect_mean(p, {0, 0, 1, 1}, expected["mean"], expected["tolerance"], name + ", whole picture");
  if (!expected.contains("pixels")) return;
  for (const json& pixel : expected["pixels"]) {
    if (pixel["value"].is_null()) continue;
    expect_mean(p, pixel["region"], pixel["value"], pixel["tolerance"],
                name + ", region " + pixel["region"].dump());
  }
}

bool is_small(const std::string& name) {
  const json expected = json::parse(read_bytes(PARIAN_SOURCE_DIR "/scenes/" + name + "/expected.json"));
  return expected["size"][0].get<double>() * expected["size"][1].get<double>() *
             expected["spp"].get<double>() <
         3e6;
}

TEST(GoldenScenes, MatchTheirExpectedValues) {
  const std::vector<std::string> names = scenes(true);
  EXPECT_GE(names.size(), 6u);
  for (const std::string& name : names)
    if (is_small(name)) check_scene(name);
}

TEST(NightlyGoldenScenes, LargeOnesMatchTheirExpectedValues) {
  for (const std::string& name : scenes(true))
    if (!is_small(name)) check_scene(name);
}

// Those whose values are not known: at least something, finite, and no sample dropped.
TEST(GoldenScenes, TheOthersRender) {
  for (const std::string& name : scenes(false)) {
    const Picture p = render(load(name), 96, 64, 4);
    double sum = 0;
    for (int i = 0; i < 96 * 64; ++i) sum += p.at(i % 96, i / 96)[1];
    EXPECT_GT(sum, 1) << name;
  }
}

// Every model beside the repository that the reader knows: a picture without a dropped sample.
TEST(NightlyRealModels, RenderWithoutDroppedSamples) {
  const fs::path assets = fs::path(PARIAN_SOURCE_DIR) / "../shared/assets";
  if (!fs::exists(assets)) GTEST_SKIP() << "no models at " << assets;
  int rendered = 0, refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(assets)) {
    const std::string extension = entry.path().extension();
    if (extension != ".glb" && extension != ".gltf") continue;
    SCOPED_TRACE(entry.path().filename().string());
    std::vector<std::string> warnings;
    Scene scene;
    try {
      scene = load_scene({entry.path()}, {}, warnings);
    } catch (const InputError&) {
      ++refused;
      continue;
    }
    add_missing_camera_and_light(scene);
    const World world = make_world(scene);
    for (int camera = 0; camera < int(world.cameras.size()); ++camera) {
      RenderSettings settings;
      settings.width = settings.height = 32;
      settings.spp = 1;
      settings.camera = camera;
      Session session(std::make_shared<const Scene>(scene), settings, make_integrator("path", {}));
      session.start();
      session.wait();
      EXPECT_EQ(session.stats().rays.dropped, 0u);
      EXPECT_EQ(session.film().min_samples(), 1u);
    }
    ++rendered;
  }
  EXPECT_GT(rendered, 40);
  EXPECT_LT(refused, 15);
}

}  // namespace
}  // namespace parian
