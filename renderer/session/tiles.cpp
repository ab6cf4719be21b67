#include "renderer/session/tiles.h"

#include <algorithm>
#include <cmath>

namespace parian {
namespace {

int whole_blocks(int pixels) { return (pixels + kBlock - 1) / kBlock * kBlock; }

/// Small tiles end a pass together, large ones cost less to check out: at most 16 pixels, and so many that a
/// thread that waits for the last one waits for a hundredth of its own share.
int suitable_size(int width, int height, int threads) {
  constexpr double kTilesPerThread = 64;
  const double side = std::sqrt(double(width) * height / (kTilesPerThread * threads));
  return std::clamp(int(side), kBlock, 4 * kBlock) / kBlock * kBlock;
}

}  // namespace

std::vector<Tile> make_tiles(int width, int height, const Tiling& tiling, int threads) {
  int tile_width = 0, tile_height = 0;
  switch (tiling.shape) {
    case TileShape::square:
      tile_width = tile_height =
          whole_blocks(tiling.size > 0 ? tiling.size : suitable_size(width, height, threads));
      break;
    case TileShape::rows:
      tile_width = whole_blocks(width);
      tile_height = kBlock;
      break;
    case TileShape::columns:
      tile_width = kBlock;
      tile_height = whole_blocks(height);
      break;
  }
  std::vector<Tile> tiles;
  for (int y = 0; y < height; y += tile_height)
    for (int x = 0; x < width; x += tile_width)
      tiles.push_back({x, y, std::min(x + tile_width, width), std::min(y + tile_height, height)});
  return tiles;
}

}  // namespace parian
