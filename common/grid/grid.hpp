// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "common/geometry/se2.hpp"

namespace tread {

/// Values of a cell: 0..100 free, the rest below. 0: roughness unknown; 1..100: roughness.
using Cell = uint8_t;
inline constexpr Cell kFree = 0;
inline constexpr Cell kCostMax = 100;
inline constexpr Cell kObstacle = 254;
inline constexpr Cell kUnknown = 255;
/// Cell sizes that a robot's map may have [m]; finer ones cost the planner minutes.
inline constexpr double kFinestCell = 0.02, kCoarsestCell = 0.5;

inline bool isFree(Cell cell) {
  return cell <= kCostMax;
}
/// RMS height of the ground about its plane that a free cell's cost stands for [m].
constexpr double roughnessOf(Cell cost) {
  return 0.001 * cost;
}
/// The cost of such a height; clamped at 10 cm.
constexpr Cell costOf(double roughness) {
  return static_cast<Cell>(std::clamp(1000.0 * roughness + 0.5, 1.0, double{kCostMax}));
}

/// a / b rounded down to an integer; b > 0.
inline int floorDivide(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

/// Index of a cell in map: the cell (0, 0) has its lower left corner in the origin of map.
struct CellIndex {
  int x = 0;
  int y = 0;
};
inline bool operator==(CellIndex a, CellIndex b) {
  return a.x == b.x && a.y == b.y;
}

/// A rectangular window of occupancy cells whose indices are fixed in map.
class Grid {
 public:
  Grid() = default;
  /// All cells unknown. `lower` is the index of the lower left cell.
  Grid(double cell_size, CellIndex lower, int width, int height);

  double cellSize() const { return cell_size_; }
  CellIndex lower() const { return lower_; }
  int width() const { return width_; }
  int height() const { return height_; }
  bool empty() const { return cells_.empty(); }

  CellIndex indexOf(const Eigen::Vector2d& p_map) const;
  /// Centre of a cell in map [m].
  Eigen::Vector2d centre(CellIndex index) const;
  bool contains(CellIndex index) const {
    return index.x >= lower_.x && index.y >= lower_.y && index.x < lower_.x + width_ &&
           index.y < lower_.y + height_;
  }
  /// The cell, or unknown outside the window.
  Cell at(CellIndex index) const { return contains(index) ? cells_[offset(index)] : kUnknown; }
  /// Sets a cell of the window; outside nothing happens.
  void set(CellIndex index, Cell cell) {
    if (contains(index)) cells_[offset(index)] = cell;
  }
  /// Row by row from the lower left, x fastest.
  const std::vector<Cell>& cells() const { return cells_; }
  std::vector<Cell>& cells() { return cells_; }
  size_t offset(CellIndex index) const {
    return static_cast<size_t>(index.y - lower_.y) * static_cast<size_t>(width_) +
           static_cast<size_t>(index.x - lower_.x);
  }

 private:
  double cell_size_ = 0.1;
  CellIndex lower_;
  int width_ = 0;
  int height_ = 0;
  std::vector<Cell> cells_;
};

/// Whether a cell may not be driven over: obstacles always, unknown cells if the caller demands it.
inline bool isBlocked(Cell cell, bool unknown_blocks) {
  return !isFree(cell) && (cell != kUnknown || unknown_blocks);
}

/// One square tile of the map, as sent on MAP.
struct Tile {
  int tile_x = 0;
  int tile_y = 0;
  int64_t utime = 0;        ///< [us] of the newest scan in it
  std::vector<Cell> cells;  ///< tile_cells x tile_cells, row by row, x fastest
};

/// The received tiles, combined. A tile stays until it is dropped for its distance.
class TileMap {
 public:
  TileMap(double cell_size, int tile_cells) : cell_size_(cell_size), tile_cells_(tile_cells) {}

  /// Takes a tile if it is not older than the present one and has the right number of cells.
  /// Returns whether any cell changed (a missing tile counts as all unknown).
  bool put(Tile tile);
  /// Drops tiles whose centre is farther than `radius` from a point [m].
  void forgetBeyond(const Eigen::Vector2d& p_map, double radius);
  /// A window of the map; cells without a tile are unknown.
  Grid window(CellIndex lower, int width, int height) const;
  double cellSize() const { return cell_size_; }
  int tileCells() const { return tile_cells_; }
  const std::map<std::pair<int, int>, Tile>& tiles() const { return tiles_; }

 private:
  double cell_size_;
  int tile_cells_;
  std::map<std::pair<int, int>, Tile> tiles_;
};

}  // namespace tread
