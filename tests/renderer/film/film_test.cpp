#include "renderer/film/film.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "tests/support/statistics.h"

namespace parian {
namespace {

/// A sample's value: depends on pixel and number only, spans ten orders of magnitude.
Rgb value(int x, int y, std::uint32_t sample) {
  Sampler sampler(SamplerKind::independent, 1, x, y, sample);
  const float scale = std::pow(10.0f, 10 * sampler.next1() - 5);
  return {scale * sampler.next1(), scale * sampler.next1(), sampler.next1()};
}

void add(FilmTile& tile, int x, int y, const Rgb& c) {
  const int width = tile.area.x1 - tile.area.x0;
  tile.pixels[std::size_t(y - tile.area.y0) * width + (x - tile.area.x0)].add(c);
}

/// Adds samples [first, last) to the film, by tiles of the given size, in the order of `backwards`.
void render(Film& film, std::uint32_t first, std::uint32_t last, int size, bool backwards = false) {
  std::vector<Tile> tiles;
  for (int y = 0; y < film.height(); y += size)
    for (int x = 0; x < film.width(); x += size)
      tiles.push_back({x, y, std::min(x + size, film.width()), std::min(y + size, film.height())});
  if (backwards) std::ranges::reverse(tiles);
  for (const Tile& area : tiles) {
    FilmTile tile = film.checkout(area);
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x)
        for (std::uint32_t i = first; i < last; ++i) add(tile, x, y, value(x, y, i));
    film.merge(tile);
  }
}

float channel(const Picture& picture, int x, int y, const std::string& name) {
  const auto found = std::ranges::find(picture.channels, name);
  EXPECT_NE(found, picture.channels.end()) << name;
  return found == picture.channels.end() ? 0 : picture.at(x, y)[found - picture.channels.begin()];
}

// Catches sums per pass that are added later (another rounding), tiles that are put in the wrong place or
// row, and a merge that adds to what was checked out.
TEST(Film, IsBitIdenticalHoweverPassesAndTilesAreCut) {
  Film whole(13, 7, {});
  render(whole, 0, 64, 100);
  for (const int size : {1, 4, 5})
    for (const bool backwards : {false, true}) {
      Film cut(13, 7, {});
      std::uint32_t done = 0;
      for (const std::uint32_t pass : {1, 2, 4, 8, 30, 19}) {
        render(cut, done, done + pass, size, backwards);
        done += pass;
      }
      EXPECT_EQ(done, 64u);
      EXPECT_EQ(cut.save(), whole.save()) << "tiles of " << size;
      EXPECT_EQ(cut.resolve().pixels, whole.resolve().pixels);
    }
}

TEST(Film, ResumesBitIdentically) {
  Film whole(6, 5, {});
  render(whole, 0, 40, 3);
  Film first(6, 5, {}), second(6, 5, {});
  render(first, 0, 17, 3);
  second.restore(first.save());
  EXPECT_EQ(second.resolve().pixels, first.resolve().pixels);
  render(second, 17, 40, 2);
  EXPECT_EQ(second.save(), whole.save());
}

TEST(Film, RefusesAStateOfAnotherFilm) {
  const Film film(4, 3, {});
  const auto restore_to = [&](int width, int height, FilmLayers layers) {
    Film(width, height, layers).restore(film.save());
  };
  EXPECT_NO_THROW(restore_to(4, 3, {}));
  EXPECT_THROW(restore_to(4, 4, {}), std::runtime_error);
  EXPECT_THROW(restore_to(4, 3, {.features = true}), std::runtime_error);
  EXPECT_THROW(Film(4, 3, {}).restore({}), std::runtime_error);
}

// 1, 2, 3, 4: mean 2.5, sample variance 5/3, of the mean 5/12. Catches a division by n in place of n - 1, the
// variance of one sample in place of the mean's, and its root.
TEST(Film, VarianceIsThatOfTheMean) {
  Film film(2, 1, {.variance = true, .sample_count = true});
  FilmTile tile = film.checkout({0, 0, 2, 1});
  for (const float c : {1, 2, 3, 4}) add(tile, 0, 0, {c, 10 * c, 5});
  add(tile, 1, 0, {7, 8, 9});
  film.merge(tile);
  const Picture picture = film.resolve();
  EXPECT_FLOAT_EQ(channel(picture, 0, 0, "R"), 2.5f);
  EXPECT_FLOAT_EQ(channel(picture, 0, 0, "G"), 25);
  EXPECT_FLOAT_EQ(channel(picture, 0, 0, "variance.R"), 5.0f / 12);
  EXPECT_FLOAT_EQ(channel(picture, 0, 0, "variance.G"), 500.0f / 12);
  EXPECT_EQ(channel(picture, 0, 0, "variance.B"), 0);
  EXPECT_EQ(channel(picture, 0, 0, "samples"), 4);
  EXPECT_EQ(channel(picture, 1, 0, "R"), 7);
  EXPECT_EQ(channel(picture, 1, 0, "variance.R"), 0) << "one sample says nothing";
  EXPECT_EQ(film.min_samples(), 1u);
}

// The layer over many samples against a two-pass sum. Catches sums in float, which cancel.
TEST(Film, VarianceSurvivesALargeMean) {
  Film film(1, 1, {});
  FilmTile tile = film.checkout({0, 0, 1, 1});
  TestRandom random(3);
  Statistics expected;
  for (int i = 0; i < 10000; ++i) {
    const float c = 1000 + random.next1();
    expected.add(c);
    add(tile, 0, 0, {c, 1000, 0});
  }
  film.merge(tile);
  const Picture picture = film.resolve();
  EXPECT_NEAR(channel(picture, 0, 0, "R"), expected.mean(), 1e-4);
  EXPECT_NEAR(channel(picture, 0, 0, "variance.R") / (expected.variance() / 10000), 1, 1e-4);
  EXPECT_NEAR(channel(picture, 0, 0, "variance.G"), 0, 1e-10);
  EXPECT_GE(channel(picture, 0, 0, "variance.G"), 0);
}

TEST(Film, ResolvesTheLayersThatWereAskedFor) {
  EXPECT_EQ(Film(1, 1, {.variance = false}).resolve().channels, (std::vector<std::string>{"R", "G", "B"}));
  Film film(2, 1, {.variance = false, .sample_count = true, .features = true});
  FilmTile tile = film.checkout({1, 0, 2, 1});
  tile.pixels[0].object = 42;
  add(tile, 1, 0, {1, 1, 1});
  add(tile, 1, 0, {3, 3, 3});
  tile.features[0] = {{1, 2, 3}, {0, 0, 2}, 9, 2, 1};
  film.merge(tile);
  const Picture picture = film.resolve();
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 1);
  EXPECT_EQ(picture.channels,
            (std::vector<std::string>{"R", "G", "B", "samples", "albedo.R", "albedo.G", "albedo.B",
                                      "normal.X", "normal.Y", "normal.Z", "depth.Z", "object.id", "sss.walk",
                                      "sss.diffusion"}));
  const std::vector<float> expected{0, 0, 0, 0, 0,    0, 0,    0, 0, 0, 0,    0,  0, 0,
                                    2, 2, 2, 2, 0.5f, 1, 1.5f, 0, 0, 1, 4.5f, 42, 1, 0.5f};
  EXPECT_EQ(picture.pixels, expected) << "pixels without a sample are black";
}

TEST(Film, ClearForgets) {
  const std::vector<char> black = Film(11, 9, {.features = true}).save();
  Film film(11, 9, {.features = true});
  render(film, 0, 3, 2);
  const std::vector<char> rendered = film.save();
  film.clear();
  EXPECT_EQ(film.save(), black);
  EXPECT_EQ(film.min_samples(), 0u);
  // One tile alone, and what was restored.
  film.merge(film.checkout({8, 4, 11, 9}));
  FilmTile tile = film.checkout({4, 4, 8, 8});
  add(tile, 3, 3, Rgb(1));
  tile.rays[0] = 7;
  film.merge(tile);
  EXPECT_NE(film.save(), black);
  film.clear();
  EXPECT_EQ(film.save(), black);
  film.restore(rendered);
  film.clear();
  EXPECT_EQ(film.save(), black);
}

// The claim of the variance layer and of the noise: over many films the spread of the mean is what they say.
TEST(Film, VariancePredictsTheSpreadOfMeans) {
  Statistics means, predicted;
  for (int i = 0; i < 2000; ++i) {
    Film film(1, 1, {});
    FilmTile tile = film.checkout({0, 0, 1, 1});
    TestRandom random(std::uint32_t(100 + i));
    for (int k = 0; k < 32; ++k) add(tile, 0, 0, Rgb(-std::log(1 - random.next1())));
    film.merge(tile);
    const Picture picture = film.resolve();
    means.add(picture.pixels[0]);
    predicted.add(channel(picture, 0, 0, "variance.R"));
  }
  EXPECT_TRUE(mean_is(means, 1, 0.02));
  EXPECT_TRUE(mean_is(predicted, 1.0 / 32, 0.06));
  EXPECT_NEAR(means.variance() * 32, 1, 4.5 * std::sqrt(2.0 / 2000) * 1.2);
}

}  // namespace
}  // namespace parian
