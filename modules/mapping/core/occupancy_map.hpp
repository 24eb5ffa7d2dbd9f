// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/footprint_size.hpp"
#include "common/grid/footprint.hpp"
#include "modules/mapping/core/ground_model.hpp"
#include "modules/mapping/core/voxel_map.hpp"

namespace tread::mapping {

/// What counts as an obstacle for this robot.
struct ObstacleConfig {
  double step = 0.15;         ///< [m] above the ground: lower things are driven over
  double robot_height = 0.0;  ///< [m] above the ground: higher things are driven under
};

/// Says what a column is, by heights above the ground of its voxels' centres.
/** With ground g, doubt u, and the band from g + step to g + robot_height:
 *  1. Obstacle: something occupied in the band, and above g + step + u.
 *  2. In doubt (occupied in the band, but no higher than g + step + u: perhaps the ground itself):
 *     free if the space above it in the band was seen free, else unknown. Driving nearer ends the
 *     doubt.
 *  3. Free: something in the band, widened by u, was seen free. Otherwise unknown.
 *  The ground is no higher than the lowest voxel that was seen: that lowers g by up to u and a
 *  cell. */
class ColumnClassifier {
 public:
  ColumnClassifier(const ObstacleConfig& config, double cell_size)
      : config_(config), cell_size_(cell_size) {}

  Cell classify(const Column& column, int lower_z, const GroundHeight& ground) const;

 private:
  uint64_t band(double from, double to, int lower_z) const;

  ObstacleConfig config_;
  double cell_size_;
};

/// The window's middle follows the robot's height only when it is this many voxels off.
inline constexpr int kMostOffHeight = kColumnHeight / 6;
/// Voxels of a column that are above the robot's ground at any time; what is higher is not kept.
inline constexpr int kVoxelsAboveGround = kColumnHeight / 2 - kMostOffHeight;

/// One beam of a scan.
struct Beam {
  Eigen::Vector3d end = Eigen::Vector3d::Zero();  ///< p_sensor of its return, or of its reach [m]
  double share = 0.0;  ///< 0 = at the time of the first beam, 1 = of the last
  bool hit = false;    ///< something was there; otherwise nothing up to `end`
};

/// One scan of a range finder with the body's motion during it.
struct Scan {
  int64_t utime = 0;                   ///< [us] of the last beam
  Eigen::Isometry3d T_map_body_first;  ///< at the time of the first beam
  Eigen::Isometry3d T_map_body_last;   ///< and of the last
  Eigen::Isometry3d T_body_sensor;
  std::vector<Beam> beams;
};

/// Everything that shapes the local map.
struct OccupancyMapConfig {
  VoxelConfig voxels;
  GroundConfig ground;
  ObstacleConfig obstacle;
  FootprintSize robot;             ///< its outline
  int tile_cells = 32;             ///< a multiple of GroundModel::kPatchCells
  int window_tiles = 8;            ///< tiles per side of the window
  double marking_range = 10.0;     ///< [m] returns from farther away mark nothing
  double clearing_range = 10.0;    ///< [m] beams clear no farther
  double start_free_radius = 1.0;  ///< [m] around the body origin where a map begins
};

/// A rolling map of the robot's surroundings: free, obstacle or unknown, from scans and poses.
/** 1. Each beam becomes a ray in map with the body's pose at that beam's time; returns from the
 *     robot itself are left out.
 *  2. The rays go into the voxels (VoxelMap), the robot's stand into the ground (GroundModel).
 *  3. Columns are classified again (ColumnClassifier) where their voxels or their ground changed.
 *  Free without having been seen are: the cells under the robot (even if something was marked
 *  there: the robot stands in it); the cells that it stood on before, and, where a map begins, all
 *  within start_free_radius, because a range finder that looks over its own robot sees neither
 *  what is beside nor behind it and the robot could not turn on the spot. In these an obstacle
 *  that is seen wins. Whoever starts the robot, or mapping anew, asserts that this radius is free.
 */
class OccupancyMap {
 public:
  /// Throws std::invalid_argument if tile_cells is no multiple of the patches or sizes are not
  /// positive.
  explicit OccupancyMap(const OccupancyMapConfig& config);

  /// Why a scan was not taken.
  enum class Refusal { kNone, kNotNewer, kToppled, kTooFar };
  /// Takes a scan, or says why not: not newer than the one before; the robot lies on its side;
  /// farther from the origin of map than OctoMap can number (32000 cells).
  Refusal insert(const Scan& scan);

  const Grid& grid() const { return grid_; }
  const OccupancyMapConfig& config() const { return config_; }
  const VoxelMap& voxels() const { return voxels_; }

  /// Indices of the tiles of the window of which something was seen, row by row.
  std::vector<CellIndex> seenTiles() const;
  /// Those that changed since they were last asked for.
  std::vector<CellIndex> takeChangedTiles();
  /// Content of a tile of the window.
  Tile tile(CellIndex index) const;

 private:
  struct TileState {
    int64_t utime = 0;  // of the newest scan that touched it
    bool changed = false;
  };
  /// Cells that are free without having been seen.
  struct Trust {
    bool stood_on = false;  // or assumed free at the start
    bool under_robot = false;
  };

  bool place(const Eigen::Isometry3d& T_map_body);
  void moveWindow(CellIndex lower, int lower_z);
  void learnGround(const GroundPlane& plane, bool window_moved);
  void assumeStartFree(const Eigen::Vector2d& p_map);
  void standAt(const Pose2& T_map_body);
  const std::vector<Ray>& raysOf(const Scan& scan);
  bool isOwnBody(const Eigen::Vector3d& p_body) const;
  void classify(size_t offset);
  void classifyPatch(CellIndex lower);
  TileState& tileOf(size_t offset);

  OccupancyMapConfig config_;
  VoxelMap voxels_;
  GroundModel ground_;
  ColumnClassifier classifier_;
  Footprint footprint_;
  Grid grid_;
  Window<Trust> trust_;
  Window<TileState> tiles_;
  std::vector<uint32_t> tile_of_cell_;     // offset of the tile of each cell
  std::vector<size_t> under_robot_;        // offsets of these cells
  std::optional<GroundPlane> last_stand_;  // set with the first scan
  std::vector<Ray> rays_;
  int64_t utime_ = 0;
};

}  // namespace tread::mapping
