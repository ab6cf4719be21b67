/// How a picture is cut into the pieces that threads render.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/film/film.h"

namespace parian {

enum class TileShape : std::uint8_t { square, rows, columns };

struct Tiling {
  TileShape shape = TileShape::square;
  int size = 0;  // side of a square in pixels; 0: what suits the picture and the threads
};

/// The tiles of a picture of width x height pixels, row by row, none empty, no pixel in two. A square's side
/// is rounded up to whole blocks; a row or a column is as thin as a block, since blocks are traced as one.
std::vector<Tile> make_tiles(int width, int height, const Tiling& tiling, int threads);

}  // namespace parian
