// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"

namespace tread::plan {

/// A grey picture, rows from the top, x fastest.
struct GreyImage {
  int width = 0;
  int height = 0;
  int white = 255;  ///< largest value of a pixel
  std::vector<uint8_t> pixels;
};

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

}  // namespace tread::plan
