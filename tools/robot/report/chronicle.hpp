// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"

namespace tread::report {

/// What became of a goal.
struct GoalStory {
  int64_t id = 0;
  double given = 0.0;  ///< [s] since the log began, when the planner first had it
  double ended = 0.0;  ///< [s] of the arrival, or when the planner had it last
  bool arrived = false;
  std::string reason;  ///< the planner's last one, where it did not arrive
};

/// A time in which channels were silent that spoke before and after it.
struct Hole {
  double begin = 0.0;   ///< [s] since the log began
  double length = 0.0;  ///< [s]
  std::vector<std::string> channels;
};

/// The whole log, beyond the first arrival.
struct Chronicle {
  std::vector<GoalStory> goals;
  std::vector<PermissionLoss> incidents;
  std::vector<Hole> holes;      ///< channels that fell silent and came back together are one
  bool incident_lasts = false;  ///< the last one, a fault or E-stop, to the log's end

  explicit Chronicle(const DriveTimeline& drive);
  /// Whether the last goal was reached, and no fault or E-stop lasts to the log's end.
  bool endsWell() const { return !goals.empty() && goals.back().arrived && !incident_lasts; }
  /// What became of it all, for one line; empty where nothing followed the first goal but
  /// `disarmed` losses of the permission.
  std::string summary(int disarmed) const;
  /// Some lines; empty for a log with one goal at most, where nothing else happened.
  std::string words() const;
};

}  // namespace tread::report
