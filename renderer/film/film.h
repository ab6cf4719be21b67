/// The film: sums of samples for each pixel, kept so that neither threads nor tiles nor a resume change a
/// bit, and their resolution into pictures.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

#include "renderer/base/image.h"
#include "renderer/base/math.h"
#include "renderer/film/noise.h"

namespace parian {

/// What the first surface of a camera path looks like; the background leaves it as it is here.
struct Features {
  Rgb albedo{0, 0, 0};
  Vec3f normal{0, 0, 0};
  float depth = 0;           // along the ray; 0 for the background
  std::uint32_t object = 0;  // node index + 1; 0 for the background
  // 1 where the path went into a dense body there and walked through it, or was diffused by it.
  float walked = 0, diffused = 0;
};

/// Pixels are rendered in blocks of kBlock x kBlock, which lie where they lie whatever the tiles; all pixels
/// of a block have the same number of samples.
inline constexpr int kBlock = 4;

/// A rectangle of pixels.
struct Tile {
  int x0, y0, x1, y1;
};

/// The running sums of one pixel. Samples are added one by one in the order of their numbers, so that the sum
/// does not depend on how passes were cut.
struct PixelSums {
  std::uint32_t samples = 0;
  std::uint32_t object = 0;  // of the first sample: an id has no mean
  double color[3] = {}, squares[3] = {};
  // The colour when the last power of two of samples was full: see variance_by_halves().
  float earlier[3] = {};

  void add(const Rgb& c) {
    if ((samples & (samples - 1)) == 0)  // 0 or a power of two; std::has_single_bit() calls a function here
      for (int k = 0; k < 3; ++k) earlier[k] = float(color[k]);
    for (int k = 0; k < 3; ++k) {
      color[k] += c[k];
      squares[k] += double(c[k]) * c[k];
    }
    ++samples;
  }
};

struct FeatureSums {
  float albedo[3] = {}, normal[3] = {}, depth = 0, walked = 0, diffused = 0;
};

struct FilmLayers {
  bool variance = true;  // variance of the mean per channel, from the pixel's own samples
  bool sample_count = false;
  bool features = false;  // albedo, normal, depth, object id, subsurface method
  bool operator==(const FilmLayers&) const = default;
};

/// One tile's pixels, filled by one thread and then merged.
struct FilmTile {
  Tile area;
  std::vector<PixelSums> pixels;      // row by row
  std::vector<FeatureSums> features;  // empty unless asked for
  std::vector<std::uint64_t> rays;    // traced so far for each block, row by row
};

class Film {
 public:
  Film(int width, int height, FilmLayers layers);
  /// What a film takes, with the pictures that are made of it.
  static std::size_t bytes(int width, int height, FilmLayers layers);

  int width() const { return width_; }
  int height() const { return height_; }
  const FilmLayers& layers() const { return layers_; }

  void clear();
  /// The sums of an area of whole blocks, to be continued.
  FilmTile checkout(const Tile& area) const;
  /// Puts an area back. Threads may merge tiles that do not overlap, and resolve, at the same time.
  void merge(const FilmTile& tile);

  /// Means so far: R, G, B and the layers. Pixels without a sample are black.
  Picture resolve() const;
  /// R, G and B alone; those who merge wait for some rows at most.
  Picture resolve_beauty() const;
  /// Smallest number of samples of any pixel.
  std::uint32_t min_samples() const;
  /// Samples of the mean pixel.
  double mean_samples() const;
  BlockNoise block_noise() const;
  Noise noise() const { return picture_noise(block_noise()); }

  /// Samples that the pixels of each block, row by row, are to have: what the render works on. The film keeps
  /// it, so that who goes on from a saved state ends the same pass first. None to begin with.
  const std::vector<std::uint32_t>& plan() const { return plan_; }
  void set_plan(std::vector<std::uint32_t> samples);
  /// Whether a pixel has fewer samples than planned.
  bool is_behind_plan() const;
  int block_columns() const { return (width_ + kBlock - 1) / kBlock; }
  int block_rows() const { return (height_ + kBlock - 1) / kBlock; }

  /// The state as bytes and back, for checkpoints. restore() throws std::runtime_error where they do not fit
  /// the film.
  std::vector<char> save() const;
  void restore(const std::vector<char>& state);

 private:
  int width_, height_;
  FilmLayers layers_;
  std::vector<PixelSums> pixels_;
  std::vector<FeatureSums> features_;
  // By blocks.
  std::vector<std::uint64_t> rays_;
  std::vector<std::uint32_t> plan_;
  std::vector<char> used_;    // something was merged there since all was black
  mutable std::mutex mutex_;  // merging is rare and short next to rendering a tile
};

}  // namespace parian
