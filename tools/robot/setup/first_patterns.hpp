// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"
#include "tools/robot/setup/interview.hpp"
#include "tools/robot/setup/robot_folder.hpp"
#include "tools/robot/setup/site.hpp"

namespace tread::setup {

/// Recipe of a robot's first patterns (config/patterns/recipes), designed for the measured values.
/** No faster than that the way from standstill to standstill is within 0.6 of `marking_range` [m].
 */
std::string recipeFor(const RobotFindings& findings);

/// Results of driving the patterns.
struct RecordedPatterns {
  PatternSet patterns;  ///< as they were driven
  recordings::SurfaceRecordings recordings;
  double worst_before = 0.0;  ///< [m] farthest that the model's end was off the driven one
};

/// Drives each pattern several times in the free circle and averages what it did. Throws
/// std::runtime_error, one line.
RecordedPatterns recordPatterns(Site& site, Interview& person, const std::string& folder,
                                const PatternSet& predicted);

/// A drive to a goal ahead.
struct GoalDrive {
  bool arrived = false;
  std::string words;  ///< how it ended
  std::vector<Pose2> track;
  double distance = 0.0;  ///< [m] from the goal at the end
};

/// Starts all processes, arms, and gives a goal so far ahead [m].
GoalDrive driveAhead(Site& site, Interview& person, const std::string& folder, double ahead);

}  // namespace tread::setup
