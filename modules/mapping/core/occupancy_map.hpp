// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "common/geometry/beam.hpp"
#include "common/geometry/se2.hpp"
#include "common/grid/footprint.hpp"
#include "common/grid/grid.hpp"
#include "modules/mapping/core/column_classifier.hpp"
#include "modules/mapping/core/ground_map.hpp"
#include "modules/mapping/core/roughness_map.hpp"
#include "modules/mapping/core/voxel_map.hpp"

namespace tread::mapping {

/// The window's middle follows the robot's height only when it is off by this many voxels.
inline constexpr int kMostOffHeight = kColumnHeight / 6;
/// Voxels of a column that are always kept above the robot's ground; higher ones are not kept.
inline constexpr int kVoxelsAboveGround = kColumnHeight / 2 - kMostOffHeight;

/// One scan of a range finder with the body's motion during it.
struct Scan {
  int64_t utime = 0;                   ///< [us] of the last beam
  Eigen::Isometry3d T_map_body_first;  ///< at the time of the first beam
  Eigen::Isometry3d T_map_body_last;   ///< and of the last
  Eigen::Isometry3d T_body_sensor;
  std::vector<Beam> beams;
};

/// Whether a return comes from the robot itself: within its slightly enlarged outline.
bool isOwnBody(const Eigen::Vector3d& p_body, const FootprintSize& robot, double height);

/// Configuration of the local map.
struct OccupancyMapConfig {
  VoxelConfig voxels;
  GroundMapConfig ground;
  ObstacleConfig obstacle;
  RoughnessConfig roughness;
  FootprintSize robot;             ///< its outline
  int tile_cells = 32;             ///< a multiple of GroundMap::kPatchCells
  int window_tiles = 8;            ///< tiles per side of the window
  double marking_range = 10.0;     ///< [m] more distant returns mark nothing
  double clearing_range = 10.0;    ///< [m] range up to which beams clear
  double start_free_radius = 0.0;  ///< [m] assumed free around the body origin where a map begins
};

/// A rolling map of the robot's surroundings: free, obstacle or unknown, from scans and poses.
/** 1. Each beam becomes a ray in map with the body's pose at that beam's time; returns from the
 *    robot itself are dropped.
 *  2. The rays update the voxels (VoxelMap), the robot's stance the ground (GroundMap). Returns on
 *     free ground update its roughness (RoughnessMap), which is the cost of free cells.
 *  3. Columns whose voxels or ground changed are classified again (ColumnClassifier). A free one
 *     whose ground was observed more than a step below that of a neighbour is an obstacle.
 *  4. Where a beam passed through the ground and ended more than a step below it, the columns
 *     under its path are unknown until ground is observed in them. Ground that slopes less than
 *     the beams is observed when the robot comes closer, ground behind an edge never is.
 * Free without observation are: the cells under the robot (even if something was marked there,
 * because the robot stands in it); the cells on which it stood before, and, where a map begins,
 * all within start_free_radius, because a range finder that looks over its own robot observes
 * neither the sides nor the rear, and the robot could not turn on the spot. In the latter two an
 * observed obstacle prevails. A person who starts the robot, or mapping again, asserts that this
 * radius is free. */
class OccupancyMap {
 public:
  /// Throws std::invalid_argument if tile_cells is no multiple of the patches or sizes are not
  /// positive.
  explicit OccupancyMap(const OccupancyMapConfig& config);

  /// Why a scan was refused.
  enum class Refusal { kNone, kNotNewer, kToppled, kTooFar };
  /// Takes a scan, or returns why it is refused: not newer than the previous one; the robot lies on
  /// its side; farther from the origin of map than OctoMap can index (32000 cells).
  Refusal insert(const Scan& scan);

  const Grid& grid() const { return grid_; }
  const OccupancyMapConfig& config() const { return config_; }
  const VoxelMap& voxels() const { return voxels_; }

  /// Indices of the tiles of the window with observations, row by row.
  std::vector<CellIndex> seenTiles() const;
  /// The tiles that changed since the last call.
  std::vector<CellIndex> takeChangedTiles();
  /// Content of a tile of the window.
  Tile tile(CellIndex index) const;

 private:
  struct TileState {
    int64_t utime = 0;  // of the newest scan that touched it
    bool changed = false;
  };
  /// What makes cells free without observation, or not free in spite of one.
  struct Trust {
    bool stood_on = false;  // or assumed free at the start
    bool under_robot = false;
    bool missed = false;  // a beam that met no ground here went far below it: there may be none
  };

  bool place(const Eigen::Isometry3d& T_map_body);
  void moveWindow(CellIndex lower, int lower_z);
  void learnGround(const GroundPlane& plane, bool window_moved);
  void learnEdges();
  void learnRoughness();
  void assumeStartFree(const Eigen::Vector2d& p_map);
  void standAt(const Pose2& T_map_body);
  const std::vector<Ray>& raysOf(const Scan& scan);
  void classify(size_t offset);
  void classifyAround(size_t offset);
  int surfaceAt(CellIndex cell) const;
  bool groundSeenAt(CellIndex cell) const;
  bool isBelowEdge(CellIndex cell) const;
  void classifyPatch(CellIndex lower, int side);
  TileState& tileOf(size_t offset);

  OccupancyMapConfig config_;
  VoxelMap voxels_;
  GroundMap ground_;
  RoughnessMap roughness_;
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

/// Which tiles to send next: changed ones first, the others in turn.
class TileSchedule {
 public:
  /// Sends up to `refresh` unchanged tiles per cycle in addition to the changed ones.
  explicit TileSchedule(size_t refresh) : refresh_(refresh) {}

  /// Begins a cycle. Tiles left over from an earlier cycle stay first if they are still in `seen`.
  /** `seen`: all tiles that may be sent; `changed`: those of them that changed, in the same order.
   */
  void begin(const std::vector<CellIndex>& seen, const std::vector<CellIndex>& changed);
  bool empty() const { return queue_.empty(); }
  /// The next tile to send; call it only if there is one.
  CellIndex take();
  void clear() { queue_.clear(); }

 private:
  bool isQueued(CellIndex tile) const;

  size_t refresh_;
  std::deque<CellIndex> queue_;
  CellIndex last_turn_;  // the last tile that was sent in turn, not for a change
};

}  // namespace tread::mapping
