// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/drive/drive_timeline.hpp"

namespace tread::report {

/// How a person's driving compares with what the planner would have done meanwhile.
struct ShadowComparison {
  int plans = 0;                     ///< made while a person drove, with what came of it known
  int same = 0;                      ///< ... whose first pattern is the motion that the person made
  int would_stand = 0;               ///< ... that had no way, or stood, while the person moved
  std::map<std::string, int> why;    ///< the planner's reasons for standing
  std::vector<double> turned_away;   ///< [rad] between both directions, where both travelled
  std::vector<double> person_speed;  ///< [m/s] there
  std::vector<double> planner_speed;
};

/// What a person drove by hand, and what the planner would have done.
struct HandRecord {
  int taken_over = 0;      ///< times
  int armed_for_hand = 0;  ///< the same
  int given_back = 0;      ///< the same
  int stopped = 0;         ///< times that it ended by a stop that needed arming
  double seconds = 0.0;    ///< [s] in the hand
  double moving = 0.0;     ///< [s] of it with a command other than zero
  double distance = 0.0;   ///< [m]
  int taught = 0;          ///< patterns
  int fair = 0;            ///< of them
  /// For each plan the first pattern, against where the robot was led in the same time.
  ShadowComparison shadow;

  explicit HandRecord(const DriveTimeline& drive);
  /// Some lines; empty where nobody drove by hand.
  std::string words() const;
};

}  // namespace tread::report
