#include "renderer/light/environment.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/chi_square.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace parian {
namespace {

/// A scene of nothing but an environment image of floats given by texel(x, y).
template <class Texel>
Scene make_sky(int width, int height, const Texel& texel, const Quatf& rotation = {1, 0, 0, 0}) {
  std::vector<float> values;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Rgb c(texel(x, y));
      values.insert(values.end(), {c.x, c.y, c.z});
    }
  Scene scene;
  scene.images.push_back(make_image(width, height, 3, PixelType::f32, values));
  scene.environment = {{1, 1, 1}, 0, rotation};
  return scene;
}

Quatf turn(const Vec3f& axis, float angle) {
  Quatf q;
  q.setAxisAngle(axis, angle);
  return q;
}

/// A direction by its image coordinates, as EXT_lights_environment puts them: u = .5 is +x, .75 is +z, the
/// top +y.
Vec3f at(double u, double v) {
  const double phi = 2 * std::numbers::pi * (u - 0.5), theta = std::numbers::pi * v;
  return Vec3f(Vec3d(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)));
}

void expect_near(const Rgb& a, const Rgb& b, float tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << k;
}

// A linear ramp along each axis. Catches a mirrored image, a turn by a quarter, and an image upside down.
TEST(EnvironmentLight, LooksTheImageUpInTheRightDirection) {
  // Red is where the column is, green the row.
  const Scene scene = make_sky(64, 32, [](int x, int y) { return Rgb((x + 0.5f) / 64, (y + 0.5f) / 32, 0); });
  const EnvironmentLight sky(scene);
  expect_near(sky.eval({1, 0, 0}), {0.5f, 0.5f, 0}, 1e-5f);
  expect_near(sky.eval({0, 0, 1}), {0.75f, 0.5f, 0}, 1e-5f);
  expect_near(sky.eval({0, 0, -1}), {0.25f, 0.5f, 0}, 1e-5f);
  EXPECT_NEAR(sky.eval({0, 1, 0}).y, 0.5f / 32, 1e-5) << "the top row is +y";
  EXPECT_NEAR(sky.eval({0, -1, 0}).y, 31.5f / 32, 1e-5);
  // -x is the seam: the mean of the first and the last column, without a break.
  expect_near(sky.eval({-1, 0, 0}), {0.5f, 0.5f, 0}, 1e-4f);
  expect_near(sky.eval(at(0.3, 0.7)), {0.3f, 0.7f, 0}, 1e-5f);
}

// world direction = rotation (environment direction). Catches the inverse.
TEST(EnvironmentLight, TurnsWithItsRotation) {
  const auto ramp = [](int x, int y) { return Rgb((x + 0.5f) / 64, (y + 0.5f) / 32, 0); };
  // A quarter about +y takes +x to -z, about +z it takes +x to +y.
  const Scene about_y = make_sky(64, 32, ramp, turn({0, 1, 0}, kPi / 2));
  expect_near(EnvironmentLight(about_y).eval({0, 0, -1}), {0.5f, 0.5f, 0}, 1e-5f);
  expect_near(EnvironmentLight(about_y).eval({1, 0, 0}), {0.75f, 0.5f, 0}, 1e-5f);
  const Scene about_z = make_sky(64, 32, ramp, turn({0, 0, 1}, kPi / 2));
  expect_near(EnvironmentLight(about_z).eval({0, 1, 0}), {0.5f, 0.5f, 0}, 1e-4f);
}

TEST(EnvironmentLight, MultipliesTheImageByTheRadiance) {
  Scene scene = make_sky(4, 2, [](int, int) { return Rgb(1, 2, 3); });
  scene.environment.radiance = {2, 3, 0.5f};
  expect_near(EnvironmentLight(scene).eval({0, 0, 1}), {2, 6, 1.5f}, 1e-5f);
}

// An 8-bit image is sRGB: 188 is .50289.
TEST(EnvironmentLight, DecodesIntegerImages) {
  Scene scene;
  scene.images.push_back(make_image<std::uint8_t>(1, 1, 3, PixelType::u8, {188, 255, 0}));
  scene.environment = {{1, 1, 1}, 0, {1, 0, 0, 0}};
  expect_near(EnvironmentLight(scene).eval({0, 0, 1}), {0.502886f, 1, 0}, 1e-5f);
}

/// A coarse image of strong contrast: one bright texel, a black row, and the poles not black.
Rgb contrast(int x, int y) {
  return Rgb(x == 5 && y == 2 ? 200.0f : y == 4 ? 0.0f : float(1 + (3 * x + y) % 5));
}

// Catches a lost sin(theta), a density per unit square, and an image that is sampled unturned.
TEST(EnvironmentLight, SamplesWithItsDensity) {
  for (const Quatf& rotation : {Quatf(1, 0, 0, 0), turn(normalize(Vec3f(1, 2, -1)), 1.1f)}) {
    const Scene scene = make_sky(16, 8, contrast, rotation);
    const EnvironmentLight sky(scene);
    TestRandom random(1);
    constexpr int kSamples = 200000;
    int differ = 0;
    const auto sample = [&]() -> std::optional<Vec3f> {
      const auto [w, radiance, pdf] = sky.sample(random.next2());
      EXPECT_NEAR(w.length(), 1, 1e-5);
      if (!(pdf > 0)) return std::nullopt;
      differ += std::abs(sky.look_up(w).pdf - pdf) > 1e-3f * pdf;
      return w;
    };
    const Vec3f axis = normalize(Vec3f(0.3f, 0.5f, 0.8f));
    const SphereCells cells{.axis = axis, .rings = 16, .sectors = 16, .tolerance = 1e-6};
    EXPECT_TRUE(samples_directions(
        sample, [&](const Vec3f& w) { return sky.look_up(w).pdf; }, cells, kSamples, 3, 1));
    // Rounding may put w into the next texel. Catches a polar angle by an arc cosine of y, too: 30 would
    // differ.
    EXPECT_LE(differ, 2);
  }
}

TEST(EnvironmentLight, WithoutImageIsUniform) {
  Scene scene;
  scene.environment.radiance = {1, 2, 3};
  const EnvironmentLight sky(scene);
  EXPECT_FALSE(sky.black());
  EXPECT_EQ(sky.eval({0, 1, 0}), Rgb(1, 2, 3));
  EXPECT_NEAR(sky.mean_luminance(), luminance({1, 2, 3}), 1e-6);
  TestRandom random(2);
  const auto sample = [&]() -> std::optional<Vec3f> {
    const auto [w, radiance, pdf] = sky.sample(random.next2());
    EXPECT_EQ(pdf, sky.look_up(w).pdf);
    return w;
  };
  EXPECT_TRUE(samples_directions(
      sample, [&](const Vec3f& w) { return sky.look_up(w).pdf; }, {}, 100000, 1, 1));
}

// Where the interpolated image shines, the density is above zero: what one bright texel spreads to its
// neighbours too.
TEST(EnvironmentLight, CanSampleEveryDirectionThatShines) {
  const Scene scene = make_sky(16, 8, [](int x, int y) { return Rgb(x == 0 && y == 3 ? 1e6f : 0); });
  const EnvironmentLight sky(scene);
  TestRandom random(3);
  int shining = 0;
  for (int i = 0; i < 100000; ++i) {
    const Vec3f w = random.direction();
    if (is_black(sky.eval(w))) continue;
    ++shining;
    ASSERT_GT(sky.look_up(w).pdf, 0);
  }
  EXPECT_GT(shining, 1000);
}

TEST(EnvironmentLight, MeanLuminanceIsThatOverTheSphere) {
  const Scene scene = make_sky(16, 8, contrast);
  const EnvironmentLight sky(scene);
  TestRandom random(4);
  Statistics mean;
  for (int i = 0; i < 400000; ++i) mean.add(luminance(sky.eval(random.direction())));
  // The table takes the sine at the middle of each row: it is not exact for eight rows.
  EXPECT_NEAR(sky.mean_luminance() / mean.mean(), 1, 0.05);
}

/// Irradiance over pi on a plate of normal n, by samples of the sky.
Statistics plate(const EnvironmentLight& sky, const Vec3f& n, int samples, std::uint32_t seed) {
  TestRandom random(seed);
  Statistics s;
  for (int i = 0; i < samples; ++i) {
    const auto [w, radiance, pdf] = sky.sample(random.next2());
    s.add(pdf > 0 ? sky.eval(w).x * std::max(0.0f, w.dot(n)) * kInvPi / pdf : 0);
  }
  return s;
}

// L = 1 + w.a: a plate facing a reflects 5/3, away from it 1/3, sideways 1. Catches axis flips and a
// missing sin(theta).
TEST(EnvironmentLight, LightsPlatesAsItsClosedForm) {
  const Vec3f axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Vec3f& a : axes) {
    const Scene scene = make_sky(
        256, 128, [&](int x, int y) { return Rgb(1 + at((x + 0.5) / 256, (y + 0.5) / 128).dot(a)); });
    const EnvironmentLight sky(scene);
    for (const Vec3f& n : axes) {
      const double along = n.dot(a);
      EXPECT_TRUE(mean_is(plate(sky, n, 100000, 5), along > 0 ? 5.0 / 3 : 1, 0.02)) << along;
      EXPECT_TRUE(mean_is(plate(sky, -n, 100000, 6), along > 0 ? 1.0 / 3 : 1, 0.04)) << along;
    }
  }
}

// A sun of 1e7 in one texel of 2048 x 1024 among ones: a plate facing it, in closed form but for the
// texel's size. Uniform sampling would not find it once.
TEST(EnvironmentLight, FindsASunOfOneTexel) {
  constexpr int kX = 2048, kY = 1024, kSunX = 700, kSunY = 400;
  const Scene scene = make_sky(kX, kY, [](int x, int y) { return Rgb(x == kSunX && y == kSunY ? 1e7f : 1); });
  const EnvironmentLight sky(scene);
  const Vec3f towards = at((kSunX + 0.5) / kX, (kSunY + 0.5) / kY);
  const double theta = std::numbers::pi * (kSunY + 0.5) / kY;
  const double texel = 2 * std::numbers::pi / kX * std::numbers::pi / kY * std::sin(theta);
  EXPECT_TRUE(mean_is(plate(sky, towards, 100000, 7), 1 + (1e7 - 1) * texel / std::numbers::pi, 0.02));
}

// Black, by its factor or by its image.
TEST(EnvironmentLight, BlackIsHarmless) {
  const Scene none;
  EXPECT_TRUE(EnvironmentLight(none).black());
  EXPECT_TRUE(is_black(EnvironmentLight(none).eval({0, 0, 1})));
  EXPECT_TRUE(EnvironmentLight().black());
  const Scene scene = make_sky(8, 4, [](int, int) { return Rgb(0); });
  const EnvironmentLight sky(scene);
  TestRandom random(8);
  EXPECT_EQ(sky.mean_luminance(), 0);
  for (int i = 0; i < 1000; ++i) {
    const auto [w, radiance, pdf] = sky.sample(random.next2());
    ASSERT_TRUE(is_finite(w) && std::isfinite(pdf) && pdf >= 0 && is_black(sky.eval(w)));
    ASSERT_TRUE(std::isfinite(sky.look_up(random.direction()).pdf));
  }
}

TEST(EnvironmentLight, StaysFiniteAtThePolesAndTheSeam) {
  const Scene scene = make_sky(16, 8, contrast);
  const EnvironmentLight sky(scene);
  for (const Vec3f& w :
       {Vec3f(0, 1, 0), Vec3f(0, -1, 0), Vec3f(-1, 0, 0), Vec3f(-1, 0, -0.0f), Vec3f(1e-20f, 1, 0)}) {
    EXPECT_TRUE(is_finite(sky.eval(w)));
    EXPECT_TRUE(std::isfinite(sky.look_up(w).pdf) && sky.look_up(w).pdf >= 0);
  }
  for (const float x : {0.0f, 0x1.fffffep-1f})
    for (const float y : {0.0f, 0x1.fffffep-1f}) {
      const EnvironmentSample s = sky.sample({x, y});
      EXPECT_TRUE(is_finite(s.wi) && is_finite(s.radiance) && std::isfinite(s.pdf) && s.pdf >= 0);
    }
}

}  // namespace
}  // namespace parian
