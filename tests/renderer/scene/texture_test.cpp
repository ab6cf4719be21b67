#include "renderer/scene/texture.h"

#include <Imath/half.h>
#include <gtest/gtest.h>

#include <vector>

#include "tests/support/scenes.h"

namespace parian {
namespace {

constexpr auto kLinear = ColorSpace::linear, kSrgb = ColorSpace::srgb;

/// IEC 61966-2-1 in double.
double decode_srgb(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

/// A scene of one float texture: a row, or a column, of these grey values.
Scene make_row(const std::vector<float>& values, Wrap wrap, Filter filter, bool column = false) {
  Scene scene;
  const int n = int(values.size());
  add_texture(scene, make_image(column ? 1 : n, column ? n : 1, 1, PixelType::f32, values),
              {0, wrap, wrap, filter});
  return scene;
}

float look_up(const Scene& scene, float u, float v = 0.5f) {
  return eval_texture(scene, scene.textures[0], {u, v}, kLinear).x;
}

/// The value of `values` that a wrap mode puts at index i, by definition.
float wrapped(const std::vector<float>& values, long i, Wrap wrap) {
  const long n = long(values.size());
  if (wrap == Wrap::clamp_to_edge) return values[std::size_t(std::clamp(i, 0L, n - 1))];
  const long period = wrap == Wrap::repeat ? n : 2 * n, k = ((i % period) + period) % period;
  return values[std::size_t(k < n ? k : period - 1 - k)];
}

// Catches a remainder of a negative number, and a mirror that repeats or loses its edge texel.
TEST(EvalTexture, WrapsEveryIndex) {
  const std::vector<float> values{1, 2, 4, 8, 16};
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge})
    for (const bool column : {false, true}) {
      const Scene nearest = make_row(values, wrap, Filter::nearest, column);
      const Scene linear = make_row(values, wrap, Filter::linear, column);
      for (long i = -23; i <= 23; ++i)
        for (const float within : {0.1f, 0.5f, 0.9f}) {
          const float u = (float(i) + within) / 5;
          const auto at = [&](const Scene& scene) {
            return column ? look_up(scene, 0.5f, u) : look_up(scene, u);
          };
          EXPECT_EQ(at(nearest), wrapped(values, i, wrap)) << int(wrap) << " at " << u;
          // Linear: the two texels whose centres are around u.
          const float other = wrapped(values, within < 0.5f ? i - 1 : i + 1, wrap),
                      share = std::abs(within - 0.5f);
          EXPECT_NEAR(at(linear), wrapped(values, i, wrap) * (1 - share) + other * share, 1e-4)
              << int(wrap) << " " << u;
        }
    }
}

TEST(EvalTexture, WrapsEachAxisByItsOwnMode) {
  Scene scene;
  add_texture(scene, make_image<float>(2, 2, 1, PixelType::f32, {1, 2, 3, 4}),
              {0, Wrap::repeat, Wrap::clamp_to_edge, Filter::nearest});
  EXPECT_EQ(look_up(scene, 1.25f, 0.25f), 1);
  EXPECT_EQ(look_up(scene, 0.25f, 1.25f), 3);
  EXPECT_EQ(look_up(scene, -0.25f, -0.25f), 2);
}

// Catches an index that overflows, and a weight outside [0, 1].
TEST(EvalTexture, StaysInRangeAtHugeCoordinates) {
  const std::vector<float> values{1, 2, 3};
  for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge})
    for (const Filter filter : {Filter::nearest, Filter::linear}) {
      const Scene scene = make_row(values, wrap, filter);
      for (const float u : {1e4f, 1e8f, 7e8f, 2e9f, 1e20f, 3e38f, kInfinity})
        for (const float sign : {1.0f, -1.0f}) {
          const float value = look_up(scene, sign * u, sign * u);
          EXPECT_TRUE(value >= 1 && value <= 3) << value << " at " << sign * u;
          if (wrap == Wrap::clamp_to_edge) {
            EXPECT_EQ(value, sign > 0 ? 3 : 1);
          }
        }
    }
}

// Texel centres are at (i + .5) / n. Catches a shift by half a texel.
TEST(EvalTexture, InterpolatesBetweenTexelCentres) {
  Scene scene;
  add_texture(scene, make_image<float>(2, 2, 1, PixelType::f32, {0, 1, 10, 21}),
              {0, Wrap::clamp_to_edge, Wrap::clamp_to_edge, Filter::linear});
  EXPECT_EQ(look_up(scene, 0.25f, 0.25f), 0) << "v grows downwards: the first row is on top";
  EXPECT_EQ(look_up(scene, 0.75f, 0.25f), 1);
  EXPECT_EQ(look_up(scene, 0.25f, 0.75f), 10);
  EXPECT_EQ(look_up(scene, 0.75f, 0.75f), 21);
  EXPECT_FLOAT_EQ(look_up(scene, 0.5f, 0.5f), 8);
  EXPECT_FLOAT_EQ(look_up(scene, 0.5f, 0.25f), 0.5f);
  EXPECT_FLOAT_EQ(look_up(scene, 0.375f, 0.25f), 0.25f);
  EXPECT_FLOAT_EQ(look_up(scene, 0.25f, 0.375f), 2.5f);
}

TEST(Texel, DecodesSrgbToAMillionth) {
  std::vector<std::uint8_t> bytes(256);
  for (int i = 0; i < 256; ++i) bytes[i] = std::uint8_t(i);
  const Image image = make_image(256, 1, 1, PixelType::u8, bytes);
  for (int i = 0; i < 256; ++i) {
    EXPECT_NEAR(texel(image, i, 0, kSrgb).x, decode_srgb(i / 255.0), 1e-6) << i;
    EXPECT_NEAR(texel(image, i, 0, kLinear).x, i / 255.0, 1e-7) << i;
  }
  EXPECT_EQ(texel(image, 255, 0, kSrgb).x, 1);
  EXPECT_EQ(texel(image, 255, 0, kLinear).x, 1);

  const std::vector<std::uint16_t> words{0, 1, 257, 2650, 2652, 30000, 65535};
  const Image deep = make_image(int(words.size()), 1, 1, PixelType::u16, words);
  for (std::size_t i = 0; i < words.size(); ++i) {
    EXPECT_NEAR(texel(deep, int(i), 0, kSrgb).x, decode_srgb(words[i] / 65535.0), 1e-6) << words[i];
    EXPECT_NEAR(texel(deep, int(i), 0, kLinear).x, words[i] / 65535.0, 1e-7) << words[i];
  }
}

TEST(Texel, FloatImagesAreLinearAlready) {
  const Image halves =
      make_image<Imath::half>(2, 1, 3, PixelType::f16, {0.5f, 2.0f, 1000.0f, 0.25f, -1.0f, 6.0e-8f});
  const Image floats = make_image<float>(1, 1, 3, PixelType::f32, {0.5f, 2e6f, -3});
  for (const ColorSpace space : {kLinear, kSrgb}) {
    EXPECT_EQ(texel(halves, 0, 0, space), Vec4f(0.5f, 2, 1000, 1));
    EXPECT_EQ(texel(halves, 1, 0, space).x, 0.25f);
    EXPECT_NEAR(texel(halves, 1, 0, space).z, 6e-8, 1e-9);
    EXPECT_EQ(texel(floats, 0, 0, space), Vec4f(0.5f, 2e6f, -3, 1));
  }
}

// Catches alpha that is decoded as a colour, and grey in red alone.
TEST(Texel, SpreadsGreyAndKeepsAlphaLinear) {
  const float decoded = float(decode_srgb(188 / 255.0)), alpha = 102.0f / 255;
  const std::vector<Vec4f> expected{{decoded, decoded, decoded, 1},
                                    {decoded, decoded, decoded, alpha},
                                    {decoded, float(decode_srgb(0.4)), 1, 1},
                                    {decoded, float(decode_srgb(0.4)), 1, alpha}};
  const std::vector<std::vector<std::uint8_t>> data{{188}, {188, 102}, {188, 102, 255}, {188, 102, 255, 102}};
  for (int channels = 1; channels <= 4; ++channels) {
    // The second texel of two, in the second row of two.
    std::vector<std::uint8_t> bytes(std::size_t(4) * channels, 7);
    std::ranges::copy(data[channels - 1], bytes.end() - channels);
    const Vec4f found = texel(make_image(2, 2, channels, PixelType::u8, bytes), 1, 1, kSrgb);
    for (int k = 0; k < 4; ++k)
      EXPECT_NEAR(found[k], expected[channels - 1][k], 1e-6) << channels << " channels, " << k;
  }
}

// Filtering happens after decoding: the middle of black and white is one half, not its sRGB value .214.
TEST(EvalTexture, FiltersLinearLight) {
  Scene scene;
  add_texture(scene, make_image<std::uint8_t>(2, 1, 1, PixelType::u8, {0, 255}),
              {0, Wrap::clamp_to_edge, Wrap::clamp_to_edge, Filter::linear});
  EXPECT_FLOAT_EQ(eval_texture(scene, scene.textures[0], {0.5f, 0.5f}, kSrgb).x, 0.5f);
}

// u' = a u + b v + c; v' = d u + e v + f of the uv set that is named.
TEST(EvalTexture, AppliesTheTransformToTheUvSet) {
  Scene scene;
  TextureRef ref =
      add_texture(scene,
                  make_image<float>(4, 4, 1, PixelType::f32,
                                    {0, 1, 2, 3, 10, 11, 12, 13, 20, 21, 22, 23, 30, 31, 32, 33}),
                  {0, Wrap::repeat, Wrap::repeat, Filter::nearest});
  const std::array<Vec2f, 2> uvs{Vec2f(0.1f, 0.1f), Vec2f(0.3f, 0.6f)};
  EXPECT_EQ(eval_texture(scene, ref, uvs, kLinear).x, 0);
  ref.uv_set = 1;
  EXPECT_EQ(eval_texture(scene, ref, uvs, kLinear).x, 21);
  ref.transform = {0, 1, 0.25f, 0.5f, 0, 0.5f};  // (.6 + .25, .15 + .5)
  EXPECT_EQ(eval_texture(scene, ref, uvs, kLinear).x, 23);
}

}  // namespace
}  // namespace parian
