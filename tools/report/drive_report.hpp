// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/grid/grid.hpp"
#include "modules/simulator/core/world.hpp"
#include "modules/simulator/truth_record.hpp"
#include "tools/report/drive_picture.hpp"
#include "tools/report/latency.hpp"
#include "tools/report/rule_errors.hpp"

namespace tread::report {

/// One drive in a log: from the first goal to the arrival, or to the log's end.
struct DriveRecord {
  std::string problem;  ///< of the log, one line; empty = whole
  int64_t events = 0;
  bool has_goal = false;
  Pose2 T_map_goal;
  int64_t begun = 0;  ///< [us] of the first goal
  int64_t ended = 0;  ///< [us] of the arrival, else of the last INS
  bool arrived = false;
  std::string last_status;  ///< the planner's last reason
  int completed = 0;        ///< executions
  int aborted = 0;
  int refused = 0;                   ///< executions that were no fair measurement
  int disarmed = 0;                  ///< times that a permission to drive was lost
  std::vector<PatternError> errors;  ///< time since begun
  std::vector<TrackPoint> track;     ///< as the INS measured, time since begun
  std::vector<TreeEdge> tree;        ///< the richest one on the way
  std::unique_ptr<TileMap> map;
  std::optional<FootprintSize> outline;  ///< of the robot; none = the log does not say
  Latencies latencies;

  double seconds() const { return static_cast<double>(ended - begun) * 1e-6; }
  /// Length of the track [m].
  double distance() const;
  double straightLine() const;
};

/// Reads logs (parts of one recording, in order) from front to back; throws std::runtime_error.
DriveRecord readDrive(const std::vector<std::string>& logs);

/// Ground truth, known in a simulation only.
struct SimulationTruth {
  std::optional<sim::WorldDescription> world;
  std::vector<sim::TruthRow> rows;  ///< empty = no record
};

/// The report as text: the result in one line, errors as driven and by rule, latencies.
std::string reportOf(const DriveRecord& drive, const SimulationTruth& truth,
                     const RuleErrors& by_rule);
/// The one line of result alone.
std::string resultLine(const DriveRecord& drive, const SimulationTruth& truth);
/// The drive to be drawn.
DriveScene sceneOf(const DriveRecord& drive, const SimulationTruth& truth,
                   const RuleErrors& by_rule);

}  // namespace tread::report
