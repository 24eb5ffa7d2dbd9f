// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"

namespace tread::report {

/// The outcome of a goal.
struct GoalStory {
  int64_t id = 0;
  double given = 0.0;  ///< [s] since the log began, when the planner first had it
  double ended = 0.0;  ///< [s] of the arrival, or of the planner's last message with it
  bool arrived = false;
  std::string reason;  ///< the planner's last reason, if it did not arrive
};

/// A gap of channels that had messages before and after it.
struct Hole {
  double begin = 0.0;   ///< [s] since the log began
  double length = 0.0;  ///< [s]
  std::vector<std::string> channels;
};

/// The whole log, beyond the first arrival.
struct Chronicle {
  std::vector<GoalStory> goals;
  std::vector<PermissionLoss> incidents;
  std::vector<Hole> holes;      ///< channels with the same gap share one hole
  bool incident_lasts = false;  ///< the last one, a fault or E-stop, until the end of the log

  explicit Chronicle(const DriveTimeline& drive);
  /// Whether the last goal was reached, and no fault or E-stop lasts to the log's end.
  bool endsWell() const { return !goals.empty() && goals.back().arrived && !incident_lasts; }
  /// Everything that followed, in one line; empty if only `disarmed` losses of the permission
  /// followed the first goal.
  std::string summary(int disarmed) const;
  /// Some lines; empty for a log with at most one goal and no other events.
  std::string words() const;
};

}  // namespace tread::report
