// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/grid/grid.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

/// Cell number along one axis; far away (and for NaN) a number outside of every window, never an
/// overflow.
int cellNumber(double coordinate, double cell_size) {
  constexpr double kFarthest = 1e9;
  const double number = std::floor(coordinate / cell_size);
  if (!(number > -kFarthest)) return static_cast<int>(-kFarthest);
  return static_cast<int>(std::min(number, kFarthest));
}

/// Copies the overlap of a tile and a window.
void copyOverlap(const Tile& tile, int tile_cells, Grid& window) {
  const CellIndex lower{tile.tile_x * tile_cells, tile.tile_y * tile_cells};
  const int x_from = std::max(lower.x, window.lower().x);
  const int x_to = std::min(lower.x + tile_cells, window.lower().x + window.width());
  const int y_from = std::max(lower.y, window.lower().y);
  const int y_to = std::min(lower.y + tile_cells, window.lower().y + window.height());
  if (x_from >= x_to) return;
  for (int y = y_from; y < y_to; ++y) {
    const auto row = tile.cells.begin() + (y - lower.y) * tile_cells + (x_from - lower.x);
    std::copy(row, row + (x_to - x_from),
              window.cells().begin() + static_cast<std::ptrdiff_t>(window.offset({x_from, y})));
  }
}

}  // namespace

Grid::Grid(double cell_size, CellIndex lower, int width, int height)
    : cell_size_(cell_size),
      lower_(lower),
      width_(std::max(width, 0)),
      height_(std::max(height, 0)),
      cells_(static_cast<size_t>(width_) * static_cast<size_t>(height_), kUnknown) {}

CellIndex Grid::indexOf(const Eigen::Vector2d& p_map) const {
  return {cellNumber(p_map.x(), cell_size_), cellNumber(p_map.y(), cell_size_)};
}

Eigen::Vector2d Grid::centre(CellIndex index) const {
  return {(index.x + 0.5) * cell_size_, (index.y + 0.5) * cell_size_};
}

bool TileMap::put(Tile tile) {
  const auto expected = static_cast<size_t>(tile_cells_) * static_cast<size_t>(tile_cells_);
  if (tile.cells.size() != expected) return false;
  const auto key = std::make_pair(tile.tile_x, tile.tile_y);
  const auto found = tiles_.find(key);
  if (found == tiles_.end()) {
    const bool any_known = std::any_of(tile.cells.begin(), tile.cells.end(),
                                       [](Cell cell) { return cell != kUnknown; });
    tiles_.emplace(key, std::move(tile));
    return any_known;
  }
  if (tile.utime < found->second.utime) return false;
  const bool changed = tile.cells != found->second.cells;
  found->second = std::move(tile);
  return changed;
}

void TileMap::forgetBeyond(const Eigen::Vector2d& p_map, double radius) {
  const double side = cell_size_ * tile_cells_;
  for (auto tile = tiles_.begin(); tile != tiles_.end();) {
    const Eigen::Vector2d centre((tile->first.first + 0.5) * side,
                                 (tile->first.second + 0.5) * side);
    tile = (centre - p_map).norm() > radius ? tiles_.erase(tile) : std::next(tile);
  }
}

Grid TileMap::window(CellIndex lower, int width, int height) const {
  Grid window(cell_size_, lower, width, height);
  const int last_x = floorDivide(lower.x + width - 1, tile_cells_);
  const int last_y = floorDivide(lower.y + height - 1, tile_cells_);
  for (int x = floorDivide(lower.x, tile_cells_); x <= last_x; ++x)
    for (int y = floorDivide(lower.y, tile_cells_); y <= last_y; ++y) {
      const auto tile = tiles_.find({x, y});
      if (tile != tiles_.end()) copyOverlap(tile->second, tile_cells_, window);
    }
  return window;
}

}  // namespace tread
