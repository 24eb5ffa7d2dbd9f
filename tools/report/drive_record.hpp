// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/grid/grid.hpp"
#include "common/log/event_log.hpp"
#include "common/report/drive_picture.hpp"
#include "tools/report/latency.hpp"

namespace tread::report {

/// What a log tells of one drive: from the first goal to the arrival, or to the log's end.
struct DriveRecord {
  std::string problem;  ///< of the log, one line; empty = whole
  int64_t events = 0;
  bool has_goal = false;
  Pose2 T_map_goal;
  int64_t begun = 0;  ///< [us] of the first goal
  int64_t ended = 0;  ///< [us] of the arrival, else of the last INS
  bool arrived = false;
  std::string last_status;  ///< the planner's last word and reason
  int completed = 0;        ///< executions
  int aborted = 0;
  int refused = 0;                           ///< executions that were no fair measurement
  int disarmed = 0;                          ///< times that a permission to drive was lost
  std::vector<report::PatternError> errors;  ///< time since begun
  std::vector<report::DriveMoment> track;    ///< as the INS measured, time since begun
  std::vector<report::TreeEdge> tree;        ///< the richest one on the way
  std::unique_ptr<TileMap> map;
  Latencies latencies;

  double seconds() const { return static_cast<double>(ended - begun) * 1e-6; }
  /// Length of the track [m].
  double distance() const;
  double straightLine() const;
};

/// Reads logs (parts of one recording, in order) from front to back; throws std::runtime_error.
DriveRecord readDrive(const std::vector<std::string>& logs);

}  // namespace tread::report
