// What a texture lookup takes: from memory, from tiles that the cache holds, from tiles that it has to read.
#include <fmt/format.h>

#include <chrono>
#include <random>
#include <vector>

#include "images/image_cache.h"
#include "renderer/scene/texture.h"
#include "tests/support/scenes.h"

namespace parian {
namespace {

constexpr int kSide = 2048, kImages = 4, kLookups = 1 << 18;

/// Places to look up: `distance` texels apart on the average, or anywhere where that is 0.
std::vector<Vec2f> make_places(float distance) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> uniform(0, 1);
  std::vector<Vec2f> places(kLookups);
  Vec2f at(0.5f, 0.5f);
  for (Vec2f& p : places) {
    const Vec2f u(uniform(random), uniform(random));
    at = distance > 0 ? at + (u - Vec2f(0.5f)) * (2 * distance / kSide) : u;
    p = at;
  }
  return places;
}

/// Nanoseconds of a lookup, the least of five rounds over all places and images.
double time(const Scene& scene, const std::vector<Vec2f>& places) {
  double least = 1e30;
  float sum = 0;
  for (int round = 0; round < 5; ++round) {
    const auto start = std::chrono::steady_clock::now();
    for (const Vec2f& p : places)
      for (const Texture& texture : scene.textures)
        sum += eval_texture(scene, texture, p, ColorSpace::srgb).x;
    const std::chrono::duration<double, std::nano> taken = std::chrono::steady_clock::now() - start;
    least = std::min(least, taken.count() / double(places.size() * scene.textures.size()));
  }
  return sum == -1 ? 0 : least;  // the sum is used, so that the lookups are made
}

void run() {
  Scene memory;
  for (int i = 0; i < kImages; ++i) {
    std::vector<std::uint8_t> texels(std::size_t(kSide) * kSide * 3);
    for (std::size_t k = 0; k < texels.size(); ++k) texels[k] = std::uint8_t(k * 2654435761u >> 13);
    add_texture(memory, make_image(kSide, kSide, 3, PixelType::u8, texels));
  }
  ImageCache large, small;
  small.limit(ImageCache::kLeastBytes);
  Scene in_large = memory, in_small = memory;
  for (Image& image : in_large.images) image = large.take(image);
  for (Image& image : in_small.images) image = small.take(image);
  fmt::print(
      "| places | memory | cache that holds all | cache that holds a quarter | tile reads of a lookup |\n");
  for (const auto& [name, distance] :
       std::vector<std::pair<const char*, float>>{{"neighbours", 0.5f}, {"near", 20.f}, {"anywhere", 0.f}}) {
    const std::vector<Vec2f> places = make_places(distance);
    const std::uint64_t before = small.statistics().tile_reads;
    fmt::print("| {} | {:.0f} ns | {:.0f} ns | {:.0f} ns |", name, time(memory, places),
               time(in_large, places), time(in_small, places));
    fmt::print(" {:.2f} |\n", double(small.statistics().tile_reads - before) / (5.0 * kLookups * kImages));
  }
}

}  // namespace
}  // namespace parian

int main() { parian::run(); }
