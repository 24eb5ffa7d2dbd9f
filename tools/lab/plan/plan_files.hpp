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
  int white = 255;  ///< the greatest value that a pixel may have
  std::vector<uint8_t> pixels;
};

/// Widest and highest that a map may be [cells], and the most cells that it may have.
inline constexpr int kLongestSide = 60'000;
inline constexpr int64_t kMostCells = 64'000'000;

/// Reads a PGM picture, P5 (bytes) or P2 (text), with comments in its header; throws ConfigError
/// "name:line: what" for anything else, 16 bits a pixel, more or fewer bytes than pixels, and sizes
/// that no map has.
GreyImage readPgm(const std::string& path);

/// The same from the file's bytes; `name` stands for the file in messages.
GreyImage parsePgm(std::string bytes, const std::string& name);

/// From which cost on a cell of an SBPL environment is what.
struct CostThresholds {
  int obstacle = 254;                ///< lethal: something is in the cell
  int inscribed = 253;               ///< no robot's centre may be in the cell
  int possibly_circumscribed = 128;  ///< a robot there may touch something, by its heading
};

/// A map as its file has it.
/** Frames: poses here, in query files and in results are in the map's own frame [m]. The grid's
 * frame has its origin in the lower left corner of the map, the corner of the cell (0, 0), whatever
 * the map's own origin is: convert with T_map_grid. */
struct MapFile {
  std::string name;   ///< the file that it was read from
  std::string image;  ///< and that of its pixels; empty if it has none
  std::string note;   ///< what a person should know of how it was read; mostly empty
  Pose2 T_map_grid;
  Grid grid;                   ///< free, obstacle, unknown; of SBPL's costs what is lethal
  std::vector<uint8_t> costs;  ///< cell by cell as in the grid; empty unless SBPL's
  CostThresholds thresholds;   ///< of the costs
  std::optional<Pose2> T_map_start;
  std::optional<Pose2> T_map_goal;
  std::optional<double> nominal_speed;  ///< [m/s]
  std::optional<double> turn_time;      ///< [s] to turn by 45 degrees on the spot
};

/// Reads a nav2 or ROS map (.yaml, .yml with its .pgm) or an SBPL environment (.cfg).
/** A nav2 map's pixels become free, obstacle and unknown as its own loader does it, in the modes
 * trinary, scale and raw; in the last two a value between free and occupied stays as the cost of a
 * free cell. Throws ConfigError with one line "file:line: what is wrong; what is needed". */
MapFile readMap(const std::string& path);

/// An SBPL environment from its text; `name` stands for the file in messages.
MapFile parseSbplEnvironment(std::string text, const std::string& name);

/// The grid for a robot with a footprint: only lethal cells are obstacles, for lesser costs are
/// others' inflation of them.
Grid gridForFootprint(const MapFile& map);

/// The grid for a point: what the map's inflation says no robot's centre may be in is an obstacle,
/// too.
Grid gridForPoint(const MapFile& map);

/// A grid on which a point is as free as a disc of this radius [m] is on the other, or less: what
/// is too near to anything blocked is an obstacle, unknown and all outside the grid included.
Grid grownBy(const Grid& grid, double radius);

/// From where to where a plan is wanted, in the map's own frame.
struct PlanQuery {
  Pose2 T_map_start;
  Pose2 T_map_goal;
};

/// Reads "x y yaw x y yaw" [m, rad] a line: start and goal; from # on a line is comment.
/** Throws ConfigError with one line "file:line: what is wrong", also for a file without any. */
std::vector<PlanQuery> readQueries(const std::string& path);

/// The same from text; `name` stands for the file in messages.
std::vector<PlanQuery> parseQueries(std::string text, const std::string& name);

/// Text of such a file; parseQueries() of it gives the same numbers, bit for bit.
std::string formatQueries(const std::vector<PlanQuery>& queries);

/// What random queries are wanted.
struct RandomQueries {
  size_t count = 100;
  uint64_t seed = 1;
  double apart = 3.0;  ///< [m] farther than this the goal is from the start
};

/// Draws starts and goals evenly over a grid's window and all headings, and keeps those that are
/// free and far enough apart; the same seed gives the same on every machine.
/** `is_free` says it of T_grid_body; T_map_grid stands the result in the map's frame. Throws
 * std::runtime_error with one line if a thousand times as many draws are not enough. */
std::vector<PlanQuery> randomQueries(const Grid& grid, const Pose2& T_map_grid,
                                     const RandomQueries& wanted,
                                     const std::function<bool(const Pose2&)>& is_free);

/// One motion primitive of a lattice planner.
struct LatticePrimitive {
  int id = 0;         ///< unique among those of a start bin only
  int start_bin = 0;  ///< heading bin in which it begins
  int dx = 0;         ///< [cells] to where it ends
  int dy = 0;
  int end_bin = 0;
  int cost_multiplier = 1;
  std::vector<Pose2> poses;  ///< from the start cell's centre in the map's axes: turned already
};

/// A set of motion primitives as its file has it.
struct PrimitiveFile {
  std::string name;              ///< the file that it was read from
  double resolution = 0.025;     ///< [m] side of a cell
  std::vector<double> headings;  ///< [rad] 0..2 pi, by bin, rising
  std::vector<LatticePrimitive> primitives;
};

/// Reads SBPL's motion primitives (.mprim), with or without stated angles.
/** A primitive is at least two poses, the first in the start's cell and bin, the last in the end's,
 * and moves or turns. Throws ConfigError with one line "file:line: primitive N: what is wrong". */
PrimitiveFile readPrimitives(const std::string& path);

/// The same from text; `name` stands for the file in messages.
PrimitiveFile parsePrimitives(std::string text, const std::string& name);

/// Reads nav2's lattice primitives (.json); what they are must hold for these, too.
PrimitiveFile readLattice(const std::string& path);

/// What is wrong with where a primitive begins and ends; empty if nothing is.
std::string endsProblem(const LatticePrimitive& primitive, const PrimitiveFile& file);

/// The bin whose heading is nearest to an angle [rad].
int nearestBin(const std::vector<double>& headings, double yaw);

/// How fast the robot is that drives primitives, which say nothing of it themselves.
struct PrimitivePace {
  double speed = 1.0;      ///< [m/s]
  double turn_time = 2.0;  ///< [s] to turn by 45 degrees
};

/// A primitive of a file as the planner searches with it; its id is its place in the list.
struct SearchPrimitive : planner::Primitive {
  int file_id = 0;               ///< as the file numbers it
  int start_bin = 0;             ///< heading bin in which it may begin
  std::vector<CellIndex> cells;  ///< of a lattice: that it passes, relative to that of its start
};

/// The primitives of start bin 0, for any heading; they cost their duration times their multiplier.
/** The duration is the slower of driving their length and turning their turn. Throws ConfigError
 * with one line if none begins there. */
std::vector<SearchPrimitive> headingFree(const PrimitiveFile& file, const PrimitivePace& pace);

/// All primitives by start bin, in the order of the file; exactly on the lattice, at SBPL's cost.
/** The cost is whole ms of the slower of driving and turning, rounded up, times the multiplier; it
 * is multiplied by the map's cost later. Source: SBPL's environment_navxythetalat (BSD), whose
 * rounding is repeated: length is the sum over the poses, the turn that between the bins' headings.
 */
std::vector<SearchPrimitive> onLattice(const PrimitiveFile& file, const PrimitivePace& pace);

}  // namespace tread::plan
