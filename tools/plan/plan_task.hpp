// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "tools/plan/map_file.hpp"
#include "tools/plan/primitives.hpp"
#include "tools/plan/query_file.hpp"

namespace tread::plan {

/// What the command line of tread-plan says.
struct PlanOptions {
  std::string map;
  std::string patterns;
  bool exact = false;
  std::string footprint;         ///< "LENGTH,WIDTH" [m]
  std::optional<double> radius;  ///< [m]
  std::string start;             ///< "x,y,yaw" [m, m, rad] in the map's frame
  std::string goal;
  std::string tolerance = "0.25,0.26";  ///< "METRES,RADIANS"
  bool come_close = false;              ///< plan to the nearest place if the goal is unreachable
  std::optional<double> deadline_ms;
  std::optional<double> speed;      ///< [m/s]
  std::optional<double> turn_time;  ///< [s]
  std::string queries;
  int64_t random = 0;  ///< queries to draw; 0 = none
  uint64_t seed = 1;
  double apart = 3.0;  ///< [m]
  std::string write_queries;
  std::string json;
  std::string picture;
};

/// The robot's outline about its origin: a rectangle, or a disc where it has no length.
struct RobotShape {
  double length = 0.0;  ///< [m]
  double width = 0.0;   ///< [m]
  double radius = 0.0;  ///< [m] 0 = a point

  bool isRectangle() const { return length > 0.0; }
  bool isPoint() const { return !isRectangle() && radius <= 0.0; }
};

/// All that is to be planned, read and checked.
struct PlanTask {
  MapFile map;
  Grid grid;  ///< of the map, for this robot; of a round one for its centre: obstacles are grown
  RobotShape shape;
  std::optional<PatternSet> patterns;       ///< of ours
  std::optional<PrimitiveFile> primitives;  ///< or of a lattice planner
  PrimitivePace pace;                       ///< of those
  bool exact = false;                       ///< and used on their lattice
  double position_tolerance = 0.25;         ///< [m]
  double yaw_tolerance = 0.26;              ///< [rad]
  bool come_close = false;
  std::optional<double> deadline_ms;  ///< none = until nothing is left to search
  std::vector<PlanQuery> queries;
  bool many = false;  ///< a report on all queries is wanted, not a plan
};

/// Reads what the options name; writes the random queries if they are wanted.
/** Throws std::runtime_error with one line for what cannot be read, and for options that contradict
 * each other. */
PlanTask loadTask(const PlanOptions& options);

/// Whether the robot stands free at a pose in the grid's frame: nothing unknown or blocked under
/// it.
bool standsFree(const PlanTask& task, const ClearanceField& clearance, const Pose2& T_grid_body);

}  // namespace tread::plan
