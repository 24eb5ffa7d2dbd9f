// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"

namespace tread::report {

/// Comparison of a person's driving with the planner's plans at the same time.
struct ShadowComparison {
  int plans = 0;                     ///< made under manual control, with a known outcome
  int same = 0;                      ///< ... with a first pattern that matches the person's motion
  int would_stand = 0;               ///< ... without a plan, or standing, while the person moved
  std::map<std::string, int> why;    ///< the planner's reasons for standing
  std::vector<double> turned_away;   ///< [rad] between both directions, if both travelled
  std::vector<double> person_speed;  ///< [m/s] at the same time
  std::vector<double> planner_speed;
};

/// A person's manual driving, and the planner's plans meanwhile.
struct HandRecord {
  int taken_over = 0;      ///< number of times
  int armed_for_hand = 0;  ///< the same
  int given_back = 0;      ///< the same
  int stopped = 0;         ///< number of ends by a stop that needed arming
  double seconds = 0.0;    ///< [s] under manual control
  double moving = 0.0;     ///< [s] of it with a nonzero command
  double distance = 0.0;   ///< [m]
  int taught = 0;          ///< patterns
  int fair = 0;            ///< of them
  /// Compares each plan's first pattern with the robot's motion in the same time.
  ShadowComparison shadow;

  explicit HandRecord(const DriveTimeline& drive);
  /// Some lines; empty without manual driving.
  std::string words() const;
};

}  // namespace tread::report
