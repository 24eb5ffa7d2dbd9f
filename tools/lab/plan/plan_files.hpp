// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::plan {

/// A grey picture, rows from the top, x fastest.
struct GreyImage {
  int width = 0;
  int height = 0;
  int white = 255;  ///< largest value of a pixel
  std::vector<uint8_t> pixels;
};

/// Limits of a map: side length [cells], number of cells.
inline constexpr int kLongestSide = 60'000;
inline constexpr int64_t kMostCells = 64'000'000;

/// Reads a PGM picture, P5 (bytes) or P2 (text), with comments in its header. Throws ConfigError
/// "name:line: error" for other formats, 16 bits per pixel, a wrong number of bytes, and
/// implausible sizes.
GreyImage readPgm(const std::string& path);

/// The same from the file's bytes; `name` replaces the file in messages.
GreyImage parsePgm(std::string bytes, const std::string& name);

/// Cost thresholds for the cells of an SBPL environment.
struct CostThresholds {
  int obstacle = 254;   ///< lethal: an obstacle in the cell
  int inscribed = 253;  ///< the robot's centre must not be in the cell
  /// a robot there may touch an obstacle, depending on its heading
  int possibly_circumscribed = 128;
};

/// Contents of a map file.
/** Frames: poses here, in query files and in results are in the map's own frame [m]. The grid's
 * frame has its origin in the lower left corner of the map, the corner of the cell (0, 0),
 * independent of the map's origin: convert with T_map_grid. */
struct MapFile {
  std::string name;   ///< its file
  std::string image;  ///< file of its pixels; empty if it has none
  std::string note;   ///< remark for people on how it was read; usually empty
  Pose2 T_map_grid;
  Grid grid;  ///< free, obstacle, unknown; of SBPL's costs only lethal cells are obstacles
  std::vector<uint8_t> costs;  ///< by cell as in the grid; only for SBPL
  CostThresholds thresholds;   ///< of the costs
  std::optional<Pose2> T_map_start;
  std::optional<Pose2> T_map_goal;
  std::optional<double> nominal_speed;  ///< [m/s]
  std::optional<double> turn_time;      ///< [s] to turn by 45 degrees on the spot
};

/// Reads a nav2 or ROS map (.yaml, .yml with its .pgm) or an SBPL environment (.cfg).
/** A nav2 map's pixels become free, obstacle and unknown as in nav2's own loader, in the modes
 * trinary, scale and raw; in the last two a value between free and occupied is kept as the cost of
 * a free cell. Throws ConfigError with one line "file:line: error; remedy". */
MapFile readMap(const std::string& path);

/// An SBPL environment from its text; `name` replaces the file in messages.
MapFile parseSbplEnvironment(std::string text, const std::string& name);

/// The grid for a robot with a footprint: only lethal cells are obstacles, because lower costs are
/// inflation for another robot.
Grid gridForFootprint(const MapFile& map);

/// The grid for a point: cells that the map's inflation forbids for a robot's centre are obstacles,
/// too.
Grid gridForPoint(const MapFile& map);

/// A grid on which a point is at most as free as a disc of this radius [m] on the original: cells
/// too close to anything blocked become obstacles, also near unknown cells and the border.
Grid grownBy(const Grid& grid, double radius);

/// Start and goal of a plan, in the map's frame.
struct PlanQuery {
  Pose2 T_map_start;
  Pose2 T_map_goal;
};

/// Reads lines "x y yaw x y yaw" [m, rad]: start and goal; # begins a comment.
/** Throws ConfigError with one line "file:line: error", also for an empty file. */
std::vector<PlanQuery> readQueries(const std::string& path);

/// The same from text; `name` replaces the file in messages.
std::vector<PlanQuery> parseQueries(std::string text, const std::string& name);

/// Text of such a file; parseQueries() of it returns bitwise the same numbers.
std::string formatQueries(const std::vector<PlanQuery>& queries);

/// Parameters of random queries.
struct RandomQueries {
  size_t count = 100;
  uint64_t seed = 1;
  double apart = 3.0;  ///< [m] least distance from start to goal
};

/// Draws starts and goals uniformly over a grid's window and all headings, and keeps pairs that are
/// free and far enough apart; a seed gives the same result on every platform.
/** `is_free` tests T_grid_body; T_map_grid converts the result to the map's frame. Throws
 * std::runtime_error with one line after a thousand times as many failed draws. */
std::vector<PlanQuery> randomQueries(const Grid& grid, const Pose2& T_map_grid,
                                     const RandomQueries& wanted,
                                     const std::function<bool(const Pose2&)>& is_free);

/// One motion primitive of a lattice planner.
struct LatticePrimitive {
  int id = 0;         ///< unique only within a start bin
  int start_bin = 0;  ///< heading bin at its start
  int dx = 0;         ///< [cells] displacement of its end
  int dy = 0;
  int end_bin = 0;
  int cost_multiplier = 1;
  std::vector<Pose2> poses;  ///< from the start cell's centre, in the map's axes (already rotated)
};

/// Contents of a file of motion primitives.
struct PrimitiveFile {
  std::string name;              ///< its file
  double resolution = 0.025;     ///< [m] side of a cell
  std::vector<double> headings;  ///< [rad] 0..2 pi, by bin, rising
  std::vector<LatticePrimitive> primitives;
};

/// Reads SBPL's motion primitives (.mprim), with or without stated angles.
/** A primitive has at least two poses, the first in the start's cell and bin, the last in the
 * end's, and moves or turns. Throws ConfigError with one line "file:line: primitive N: error". */
PrimitiveFile readPrimitives(const std::string& path);

/// The same from text; `name` replaces the file in messages.
PrimitiveFile parsePrimitives(std::string text, const std::string& name);

/// Reads nav2's lattice primitives (.json), with the same requirements.
PrimitiveFile readLattice(const std::string& path);

/// Inconsistency of a primitive's start or end; empty if none.
std::string endsProblem(const LatticePrimitive& primitive, const PrimitiveFile& file);

/// The bin with the heading nearest to an angle [rad].
int nearestBin(const std::vector<double>& headings, double yaw);

/// Speed of the robot that drives primitives, which contain no speed themselves.
struct PrimitivePace {
  double speed = 1.0;      ///< [m/s]
  double turn_time = 2.0;  ///< [s] to turn by 45 degrees
};

/// A primitive for the planner's search; its id is its index.
struct SearchPrimitive : planner::Primitive {
  int file_id = 0;    ///< number in the file
  int start_bin = 0;  ///< heading bin in which it may start
  /// for a lattice: the cells that it passes, relative to the start's
  std::vector<CellIndex> cells;
};

/// The primitives of start bin 0, for any heading; the cost is their duration times their
/// multiplier.
/** The duration is the longer of driving their length and turning their angle. Throws ConfigError
 * with one line if none starts there. */
std::vector<SearchPrimitive> headingFree(const PrimitiveFile& file, const PrimitivePace& pace);

/// All primitives by start bin, in the order of the file, exactly on the lattice with SBPL's cost.
/** The cost is whole ms of the slower of driving and turning, rounded up, times the multiplier; it
 * is multiplied by the map's cost later. Source: SBPL's environment_navxythetalat (BSD), whose
 * rounding is repeated: length is the sum over the poses, the turn that between the bins' headings.
 */
std::vector<SearchPrimitive> onLattice(const PrimitiveFile& file, const PrimitivePace& pace);

}  // namespace tread::plan
