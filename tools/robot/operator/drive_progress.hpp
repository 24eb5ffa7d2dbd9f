// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <string>

#include "common/bus/bus.hpp"
#include "common/geometry/se2.hpp"

namespace tread::operators {

/// Name of the ground at a point of the map, where somebody knows it.
using SurfaceNames = std::function<std::string(const Eigen::Vector2d& p_map)>;

/// Follows a drive on the bus and tells it in one line.
class DriveProgress {
 public:
  DriveProgress(Bus& bus, const Pose2& T_map_goal, SurfaceNames surface_names);

  /// "to go 12.3 m  driving  left-soft on gravel  last error 0.04 m 1.2 deg  set 17".
  std::string line(int64_t utime) const;
  /// Distance to the goal [m]; NaN while there is no pose.
  double toGo() const;
  const Latest<plan_t>& plan() const { return plan_; }
  const Latest<motor_t>& motor() const { return motor_; }

 private:
  std::string patternName(int32_t id) const;

  Pose2 T_map_goal_;
  SurfaceNames surface_names_;
  Latest<ins_t> ins_;
  Latest<plan_t> plan_;
  Latest<motor_t> motor_;
  Latest<execution_t> execution_;
  Latest<learning_t> learning_;
  std::map<int32_t, std::string> names_;  ///< of patterns by id
};

/// A planner's status in a word.
std::string statusWord(int16_t plan_status);

}  // namespace tread::operators
