// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/grid/clearance.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"

namespace tread::planner {

/// How much of the map is kept, and its coarse resolution.
struct ClearanceMapConfig {
  double keep_radius = 40.0;   ///< [m] tiles farther from the vehicle are forgotten
  double clearance_cap = 0.8;  ///< [m] larger clearances are stored as this
  int coarse = 2;              ///< cells of the map per side of a coarse cell
};

/// Coarse cells of one tile.
struct ClearanceTile {
  std::vector<float> clearance;  ///< [m] largest distance to an obstacle in the cell, capped
  std::vector<uint8_t> unknown;  ///< 1 where at least half of the cell is unknown
  std::vector<Cell> roughness;   ///< the largest cost of the free cells in it
};

/// All tiles seen so far, including those that mapping has forgotten, and the clearance in coarse
/// cells.
/** Dead ends stay known after the local map has moved on. Unknown counts as passable, because it
 * may be free. */
class ClearanceMap : public ClearanceSource {
 public:
  ClearanceMap(double cell_size, int tile_cells, const ClearanceMapConfig& config);

  /// Takes a tile. Its unknown cells keep their earlier values. Returns whether anything changed.
  bool put(Tile tile);
  /// Makes unknown cells free, because the vehicle stands on them.
  void assumeFree(const std::vector<CellIndex>& cells);
  void forgetBeyond(const Eigen::Vector2d& p_map);
  /// Updates the clearance in the tiles that changed, and in their neighbours.
  void refresh();

  /// Window of the map with full resolution.
  Grid window(CellIndex lower, int width, int height) const {
    return tiles_.window(lower, width, height);
  }
  double cellSize() const { return tiles_.cellSize(); }
  int tileCells() const { return tiles_.tileCells(); }
  double coarseSize() const override { return cellSize() * coarse_; }
  void fill(ClearanceWindow& window) const override;
  /// Increases whenever a cell changes.
  int64_t revision() const { return revision_; }
  /// Increases whenever the clearance or the unknown flag of a coarse cell changes.
  int64_t clearanceRevision() const { return clearance_revision_; }
  /// [us] of the newest scan in any tile; 0 before the first.
  int64_t newestUtime() const { return newest_utime_; }
  bool empty() const { return tiles_.tiles().empty(); }
  const std::map<std::pair<int, int>, ClearanceTile>& clearances() const { return clearances_; }
  int coarsePerTile() const { return tileCells() / coarse_; }

 private:
  /// What a new tile changes.
  enum class Change { kNone, kKnowledge, kObstacles };
  Change merge(Tile& tile) const;
  /// Tiles from left to right and from bottom to top, inclusive.
  struct TileBox {
    int left;
    int bottom;
    int right;
    int top;
  };
  void refreshKnowledge(std::pair<int, int> key);
  void refreshClearances(const std::vector<std::pair<int, int>>& keys);
  bool refreshUnknown(const Tile& tile, ClearanceTile& coarse_tile) const;
  bool refreshClearance(std::pair<int, int> key, const ClearanceField& field,
                        ClearanceTile& coarse_tile) const;
  ClearanceField fieldOver(const TileBox& box) const;

  TileMap tiles_;
  ClearanceMapConfig config_;
  int coarse_;
  std::map<std::pair<int, int>, ClearanceTile> clearances_;
  std::map<std::pair<int, int>, Change> dirty_;
  int64_t revision_ = 0;
  int64_t clearance_revision_ = 0;
  int64_t newest_utime_ = 0;
};

/// Clearance in coarse cells of a static map, and the areas connected for a disc.
class CoarseClearance : public ClearanceSource {
 public:
  /// A coarse cell has `coarse` cells of the grid per side; its clearance is the largest at their
  /// centres, and 0 outside the grid.
  CoarseClearance(const Grid& grid, const ClearanceField& field, int coarse);

  double coarseSize() const override { return size_; }
  std::optional<ClearanceWindow> bounds() const override { return cells_; }
  void fill(ClearanceWindow& window) const override;

  /// Numbers the areas in which a disc of this radius [m] can move, for areaAt().
  void label(double radius);
  /// Number of the area that contains a point; 0 = no clearance for the disc, or outside.
  int areaAt(const Eigen::Vector2d& p_map) const;
  /// Numbers of the areas within a distance of a point [m].
  std::vector<int> areasNear(const Eigen::Vector2d& p_map, double distance) const;
  /// Centre of the coarse cell of these areas that is nearest to a point; nullopt if there is none.
  std::optional<Eigen::Vector2d> nearestIn(const std::vector<int>& areas,
                                           const Eigen::Vector2d& p_map) const;

 private:
  bool contains(int x, int y) const {
    return x >= cells_.lower_x && y >= cells_.lower_y && x < cells_.lower_x + cells_.width &&
           y < cells_.lower_y + cells_.height;
  }
  Eigen::Vector2d centreOf(int x, int y) const { return {(x + 0.5) * size_, (y + 0.5) * size_}; }
  void flood(int x, int y, int number, float radius);

  double size_;
  ClearanceWindow cells_;
  std::vector<int> area_;
};

}  // namespace tread::planner
