// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/grid/grid.hpp"

using namespace tread;

namespace {

Tile tileOf(int tile_x, int tile_y, int64_t utime, Cell cell) {
  return {tile_x, tile_y, utime, std::vector<Cell>(16, cell)};
}

}  // namespace

TEST_CASE("tiles fill the window that they cover, the rest stays unknown") {
  TileMap map(0.1, 4);
  REQUIRE(map.put(tileOf(-1, 0, 5, kFree)));
  REQUIRE(map.put(tileOf(0, 0, 6, kObstacle)));
  const Grid window = map.window({-6, -1}, 8, 6);
  REQUIRE(window.lower() == CellIndex{-6, -1});
  for (int y = -1; y < 5; ++y)
    for (int x = -6; x < 2; ++x) {
      const bool covered = y >= 0 && y < 4 && x >= -4;
      const Cell expected = !covered ? kUnknown : x < 0 ? kFree : kObstacle;
      CAPTURE(x, y);
      REQUIRE(window.at({x, y}) == expected);
    }
}

TEST_CASE(
    "a tile's cells land in the order in which they are sent: x fastest, from the lower left") {
  TileMap map(0.1, 4);
  Tile tile = tileOf(1, -2, 1, kFree);
  for (size_t i = 0; i < 16; ++i) tile.cells[i] = static_cast<Cell>(i);
  map.put(tile);
  const Grid window = map.window({0, -8}, 12, 8);
  REQUIRE(window.at({4, -8}) == 0);
  REQUIRE(window.at({7, -8}) == 3);
  REQUIRE(window.at({4, -7}) == 4);
  REQUIRE(window.at({7, -5}) == 15);
}

TEST_CASE("older tiles and tiles of the wrong size are refused, equal content is no change") {
  TileMap map(0.1, 4);
  REQUIRE(map.put(tileOf(0, 0, 10, kFree)));
  REQUIRE_FALSE(map.put(tileOf(0, 0, 9, kObstacle)));
  REQUIRE_FALSE(map.put(tileOf(0, 0, 11, kFree)));
  REQUIRE(map.tiles().at({0, 0}).utime == 11);
  REQUIRE(map.put(tileOf(0, 0, 11, kObstacle)));
  REQUIRE_FALSE(map.put({0, 0, 12, std::vector<Cell>(15, kFree)}));
  REQUIRE(map.window({0, 0}, 1, 1).at({0, 0}) == kObstacle);
  REQUIRE_FALSE(map.put(tileOf(5, 5, 1, kUnknown)));
}

TEST_CASE("tiles are forgotten by the distance of their centres") {
  TileMap map(0.1, 4);
  map.put(tileOf(0, 0, 1, kFree));
  map.put(tileOf(10, 0, 1, kFree));
  map.forgetBeyond({0.2, 0.2}, 3.9);
  REQUIRE(map.tiles().size() == 1);
}
