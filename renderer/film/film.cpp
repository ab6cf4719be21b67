#include "renderer/film/film.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace parian {
namespace {

/// Variance of the mean of n values with these sums; 0 where one value alone says nothing.
double variance_of_mean(double sum, double squares, std::uint32_t n) {
  if (n < 2) return 0;
  return std::max(0.0, (squares - sum * sum / n) / (double(n) - 1)) / n;
}

/// Variance of the mean of a pixel's channel, by the difference of the mean of its first 2^k samples, more
/// than half of them or just half, from that of the rest. Of independent samples it is as good as
/// variance_of_mean() on the average, of pixels; of Sobol samples, which have less error than their variance
/// says, it is near what they have (and not below: such halves make up for each other).
double variance_by_halves(const PixelSums& p, int k) {
  if (p.samples < 2) return 0;
  const double n = p.samples, n1 = std::bit_floor(p.samples - 1), n2 = n - n1;
  const double difference = p.earlier[k] / n1 - (p.color[k] - p.earlier[k]) / n2;
  return difference * difference * (n1 / n) * (n2 / n);
}

/// The blocks that an area covers.
Tile blocks_of(const Tile& area) {
  return {area.x0 / kBlock, area.y0 / kBlock, (area.x1 + kBlock - 1) / kBlock,
          (area.y1 + kBlock - 1) / kBlock};
}

}  // namespace

Film::Film(int width, int height, FilmLayers layers)
    : width_(width),
      height_(height),
      layers_(layers),
      pixels_(std::size_t(width) * height),
      features_(layers.features ? pixels_.size() : 0),
      rays_(std::size_t(block_columns()) * block_rows()),
      plan_(rays_.size()),
      used_(rays_.size()) {}

std::size_t Film::bytes(int width, int height, FilmLayers layers) {
  // A picture is resolved, its layers are selected, and it is encoded.
  const std::size_t channels =
      3 + (layers.variance ? 3 : 0) + (layers.sample_count ? 1 : 0) + (layers.features ? 10 : 0);
  const std::size_t pixel =
      sizeof(PixelSums) + (layers.features ? sizeof(FeatureSums) : 0) + 3 * sizeof(float) * channels;
  return pixel * std::size_t(width) * std::size_t(height);
}

void Film::clear() {
  const std::lock_guard lock(mutex_);
  // What was never merged is black already. Where a hand moves, edit after edit, that is most of a picture of
  // many megabytes.
  for (std::size_t block = 0; block < used_.size(); ++block) {
    if (!std::exchange(used_[block], false)) continue;
    const int x0 = int(block % block_columns()) * kBlock, x1 = std::min(x0 + kBlock, width_);
    const int y0 = int(block / block_columns()) * kBlock, y1 = std::min(y0 + kBlock, height_);
    for (int y = y0; y < y1; ++y) {
      const std::size_t first = std::size_t(y) * width_ + x0;
      std::fill_n(pixels_.begin() + first, x1 - x0, PixelSums());
      if (layers_.features) std::fill_n(features_.begin() + first, x1 - x0, FeatureSums());
    }
    rays_[block] = 0;
  }
  std::ranges::fill(plan_, 0u);
}

FilmTile Film::checkout(const Tile& area) const {
  FilmTile tile{area, {}, {}, {}};
  const std::lock_guard lock(mutex_);
  const auto take = [](auto& to, const auto& from, std::size_t first, std::size_t last) {
    to.insert(to.end(), from.begin() + first, from.begin() + last);
  };
  for (int y = area.y0; y < area.y1; ++y) {
    const std::size_t row = std::size_t(y) * width_;
    take(tile.pixels, pixels_, row + area.x0, row + area.x1);
    if (layers_.features) take(tile.features, features_, row + area.x0, row + area.x1);
  }
  const Tile blocks = blocks_of(area);
  for (int y = blocks.y0; y < blocks.y1; ++y) {
    const std::size_t row = std::size_t(y) * block_columns();
    take(tile.rays, rays_, row + blocks.x0, row + blocks.x1);
  }
  return tile;
}

void Film::merge(const FilmTile& tile) {
  const std::lock_guard lock(mutex_);
  const auto put = [](const auto& from, auto& to, const Tile& area, int columns) {
    const std::size_t width = std::size_t(area.x1 - area.x0);
    for (int y = area.y0; y < area.y1; ++y)
      std::copy_n(from.begin() + (y - area.y0) * width, width,
                  to.begin() + std::size_t(y) * columns + area.x0);
  };
  put(tile.pixels, pixels_, tile.area, width_);
  if (layers_.features) put(tile.features, features_, tile.area, width_);
  const Tile blocks = blocks_of(tile.area);
  put(tile.rays, rays_, blocks, block_columns());
  for (int y = blocks.y0; y < blocks.y1; ++y)
    std::fill_n(used_.begin() + std::size_t(y) * block_columns() + blocks.x0, blocks.x1 - blocks.x0, true);
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

Picture Film::resolve_beauty() const {
  Picture picture{width_, height_, {"R", "G", "B"}, std::vector<float>(3 * pixels_.size()), {}};
  constexpr int kRows = 16;
  for (int y0 = 0; y0 < height_; y0 += kRows) {
    const std::size_t end = std::size_t(std::min(y0 + kRows, height_)) * width_;
    const std::lock_guard lock(mutex_);
    for (std::size_t i = std::size_t(y0) * width_; i < end; ++i) {
      const PixelSums& p = pixels_[i];
      const double scale = p.samples ? 1.0 / p.samples : 0;
      for (int k = 0; k < 3; ++k) picture.pixels[3 * i + k] = float(p.color[k] * scale);
    }
  }
  return picture;
}

std::uint32_t Film::min_samples() const {
  const std::lock_guard lock(mutex_);
  std::uint32_t least = 0xffffffffu;
  for (const PixelSums& p : pixels_)
    if (least = std::min(least, p.samples); least == 0) break;
  return least;
}

double Film::mean_samples() const {
  const std::lock_guard lock(mutex_);
  double sum = 0;
  for (const PixelSums& p : pixels_) sum += p.samples;
  return sum / double(pixels_.size());
}

BlockNoise Film::block_noise() const {
  BlockNoise noise{block_columns(), block_rows(), {}, {}, {}, {}, {}};
  std::vector<double> mean(plan_.size());
  double picture_mean = 0;
  const std::lock_guard lock(mutex_);
  for (int y0 = 0; y0 < height_; y0 += kBlock)
    for (int x0 = 0; x0 < width_; x0 += kBlock) {
      const int x1 = std::min(x0 + kBlock, width_), y1 = std::min(y0 + kBlock, height_);
      double sum = 0, variance = 0;
      std::uint32_t least = 0xffffffffu;
      for (int y = y0; y < y1; ++y)
        for (int x = x0; x < x1; ++x) {
          const PixelSums& p = pixels_[std::size_t(y) * width_ + x];
          least = std::min(least, p.samples);
          for (int k = 0; k < 3 && p.samples; ++k) {
            sum += p.color[k] / p.samples;
            variance += variance_by_halves(p, k);
          }
        }
      const double pixels = double(x1 - x0) * (y1 - y0);
      noise.cost.push_back(least ? double(rays_[noise.cost.size()]) / (pixels * least) : 1);
      mean[noise.error.size()] = sum / (3 * pixels);
      noise.error.push_back(least < 2 ? INFINITY : variance / (3 * pixels));
      noise.samples.push_back(least);
      noise.weight.push_back(pixels / double(pixels_.size()));
      picture_mean += noise.weight.back() * mean[noise.error.size() - 1];
    }
  const double floor = kNoiseFloor * picture_mean;
  for (std::size_t b = 0; b < mean.size(); ++b) {
    const double variance = noise.error[b], pixels = noise.weight[b] * double(pixels_.size());
    const double least = std::max(0.0, mean[b] - kNoiseQuantile * std::sqrt(variance / pixels));
    const auto relative = [&](double m) { return variance > 0 ? variance / (m * m + floor * floor) : 0; };
    noise.error[b] = relative(mean[b]);
    noise.most_error.push_back(relative(least));
  }
  return noise;
}

void Film::set_plan(std::vector<std::uint32_t> samples) {
  const std::lock_guard lock(mutex_);
  plan_ = std::move(samples);
}

bool Film::is_behind_plan() const {
  const std::lock_guard lock(mutex_);
  for (int y = 0; y < height_; y += kBlock)
    for (int x = 0; x < width_; x += kBlock) {
      const std::uint32_t planned = plan_[std::size_t(y / kBlock) * block_columns() + x / kBlock];
      // A film that nothing is planned for yet is not looked at.
      if (planned > 0 && pixels_[std::size_t(y) * width_ + x].samples < planned) return true;
    }
  return false;
}

std::vector<char> Film::save() const {
  const std::lock_guard lock(mutex_);
  std::vector<char> state;
  const auto put = [&](const auto& values) {
    const auto* bytes = reinterpret_cast<const char*>(values.data());
    state.insert(state.end(), bytes, bytes + values.size() * sizeof(values[0]));
  };
  put(pixels_);
  put(features_);
  put(rays_);
  put(plan_);
  return state;
}

void Film::restore(const std::vector<char>& state) {
  const std::lock_guard lock(mutex_);
  const char* from = state.data();
  const auto size = [](const auto& values) { return values.size() * sizeof(values[0]); };
  if (state.size() != size(pixels_) + size(features_) + size(rays_) + size(plan_))
    throw std::runtime_error("the saved film has another size or other layers");
  const auto take = [&](auto& values) {
    if (!values.empty()) std::memcpy(values.data(), from, size(values));
    from += size(values);
  };
  take(pixels_);
  take(features_);
  take(rays_);
  take(plan_);
  std::ranges::fill(used_, true);
}

}  // namespace parian
