#include "renderer/film/film.h"

#include <cstring>
#include <stdexcept>

namespace parian {
namespace {

/// Variance of the mean of n values with these sums; 0 where one value alone says nothing.
double variance_of_mean(double sum, double squares, std::uint32_t n) {
  if (n < 2) return 0;
  return std::max(0.0, (squares - sum * sum / n) / (double(n) - 1)) / n;
}

}  // namespace

Film::Film(int width, int height, FilmLayers layers) : width_(width), height_(height), layers_(layers) {
  clear();
}

void Film::clear() {
  const std::lock_guard lock(mutex_);
  pixels_.assign(std::size_t(width_) * height_, {});
  features_.assign(layers_.features ? pixels_.size() : 0, {});
}

FilmTile Film::checkout(const Tile& area) const {
  FilmTile tile{area, {}, {}};
  const std::lock_guard lock(mutex_);
  for (int y = area.y0; y < area.y1; ++y) {
    const std::size_t row = std::size_t(y) * width_;
    tile.pixels.insert(tile.pixels.end(), pixels_.begin() + row + area.x0, pixels_.begin() + row + area.x1);
    if (layers_.features)
      tile.features.insert(tile.features.end(), features_.begin() + row + area.x0,
                           features_.begin() + row + area.x1);
  }
  return tile;
}

void Film::merge(const FilmTile& tile) {
  const std::lock_guard lock(mutex_);
  const int width = tile.area.x1 - tile.area.x0;
  for (int y = tile.area.y0; y < tile.area.y1; ++y) {
    const std::size_t from = std::size_t(y - tile.area.y0) * width,
                      to = std::size_t(y) * width_ + tile.area.x0;
    std::copy_n(tile.pixels.begin() + from, width, pixels_.begin() + to);
    if (layers_.features) std::copy_n(tile.features.begin() + from, width, features_.begin() + to);
  }
}

Picture Film::resolve() const {
  Picture picture{width_, height_, {"R", "G", "B"}, {}, {}};
  const auto add = [&](std::initializer_list<const char*> names) {
    picture.channels.insert(picture.channels.end(), names.begin(), names.end());
  };
  if (layers_.variance) add({"variance.R", "variance.G", "variance.B"});
  if (layers_.sample_count) add({"samples"});
  if (layers_.features)
    add({"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "object.id",
         "sss.walk", "sss.diffusion"});
  picture.pixels.reserve(picture.channels.size() * pixels_.size());
  const auto put = [&](double value) { picture.pixels.push_back(float(value)); };

  const std::lock_guard lock(mutex_);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    const PixelSums& p = pixels_[i];
    const double scale = p.samples ? 1.0 / p.samples : 0;
    for (double c : p.color) put(c * scale);
    if (layers_.variance)
      for (int k = 0; k < 3; ++k) put(variance_of_mean(p.color[k], p.squares[k], p.samples));
    if (layers_.sample_count) put(p.samples);
    if (layers_.features) {
      const FeatureSums& f = features_[i];
      for (float c : f.albedo) put(c * scale);
      for (float c : f.normal) put(c * scale);
      put(f.depth * scale);
      put(p.object);
      put(f.walked * scale);
      put(f.diffused * scale);
    }
  }
  return picture;
}

std::uint32_t Film::min_samples() const {
  const std::lock_guard lock(mutex_);
  std::uint32_t least = 0xffffffffu;
  for (const PixelSums& p : pixels_) least = std::min(least, p.samples);
  return least;
}

double Film::relative_noise() const {
  const std::lock_guard lock(mutex_);
  double variance = 0, sum = 0;
  for (const PixelSums& p : pixels_)
    for (int k = 0; k < 3 && p.samples; ++k) {
      variance += variance_of_mean(p.color[k], p.squares[k], p.samples);
      sum += p.color[k] / p.samples;
    }
  const double count = 3.0 * double(pixels_.size());
  return sum > 0 ? std::sqrt(variance / count) / (sum / count) : 0;
}

std::vector<char> Film::save() const {
  const std::lock_guard lock(mutex_);
  const std::size_t pixel_bytes = pixels_.size() * sizeof(PixelSums);
  std::vector<char> state(pixel_bytes + features_.size() * sizeof(FeatureSums));
  std::memcpy(state.data(), pixels_.data(), pixel_bytes);
  if (!features_.empty())
    std::memcpy(state.data() + pixel_bytes, features_.data(), state.size() - pixel_bytes);
  return state;
}

void Film::restore(const std::vector<char>& state) {
  const std::lock_guard lock(mutex_);
  const std::size_t pixel_bytes = pixels_.size() * sizeof(PixelSums);
  if (state.size() != pixel_bytes + features_.size() * sizeof(FeatureSums))
    throw std::runtime_error("the saved film has another size or other layers");
  std::memcpy(pixels_.data(), state.data(), pixel_bytes);
  if (!features_.empty())
    std::memcpy(features_.data(), state.data() + pixel_bytes, state.size() - pixel_bytes);
}

}  // namespace parian
