#include "renderer/session/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace parian {
namespace {

const Tiling kTilings[] = {{TileShape::rows},       {TileShape::columns},     {TileShape::square, 0},
                           {TileShape::square, 1},  {TileShape::square, 13},  {TileShape::square, 16},
                           {TileShape::square, 64}, {TileShape::square, 9999}};

// Also that tiles begin at blocks: one that is cut by a tile would be two packets of other paths.
TEST(Tiles, CoverEachPixelOnceByWholeBlocks) {
  for (const Tiling& tiling : kTilings)
    for (const auto& [width, height] : {std::pair{1, 1}, {4, 4}, {53, 37}, {37, 130}, {1, 9}})
      for (const int threads : {1, 16}) {
        std::vector<int> visits(std::size_t(width) * height);
        for (const Tile& tile : make_tiles(width, height, tiling, threads)) {
          ASSERT_LT(tile.x0, tile.x1);
          ASSERT_LT(tile.y0, tile.y1);
          EXPECT_EQ(tile.x0 % kBlock, 0);
          EXPECT_EQ(tile.y0 % kBlock, 0);
          for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; ++x) ++visits.at(std::size_t(y) * width + x);
        }
        EXPECT_EQ(std::ranges::count(visits, 1), width * height);
      }
}

TEST(Tiles, HaveTheShapeAskedFor) {
  const auto count = [](Tiling tiling, int threads = 2) {
    return make_tiles(400, 200, tiling, threads).size();
  };
  EXPECT_EQ(count({TileShape::rows}), 50u);
  EXPECT_EQ(count({TileShape::columns}), 100u);
  EXPECT_EQ(count({TileShape::square, 100}), 8u);
  EXPECT_EQ(count({TileShape::square, 3}), 5000u) << "rounded up to a block";
  EXPECT_EQ(count({TileShape::square, 0}), 25u * 13) << "16 pixels where that gives enough of them";
  EXPECT_EQ(count({TileShape::square, 0}, 16), 50u * 25) << "smaller for more threads";
}

}  // namespace
}  // namespace parian
