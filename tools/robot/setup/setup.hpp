// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/robot/setup/first_patterns.hpp"
#include "tools/robot/setup/interview.hpp"
#include "tools/robot/setup/robot_folder.hpp"
#include "tools/robot/setup/site.hpp"
#include "tools/robot/setup/trials.hpp"

namespace tread::setup {

/// Whether two things that must fit do.
struct FitCheck {
  bool good = true;
  std::string words;  ///< what, with numbers; what to do where it is not
};

/// All that a setup has found out; one line of `problem` where it could not go on.
struct SetupResult {
  std::string folder;
  RobotFindings findings;
  LiftReport lift;
  GroundReport ground;
  std::optional<RecordedPatterns> recorded;
  std::vector<FitCheck> checks;
  GoalDrive goal;
  double minutes = 0.0;
  std::string problem;
};

/// Footprint, ranges, stopping distance, rates and leases of what was found, against each other.
std::vector<FitCheck> checkFit(const SetupResult& result);

/// Sets a robot up from nothing: ports, wiring, motion, patterns, first goal, and writes its folder
/// below `robots`. Never throws for what the robot does: that is the result's problem.
SetupResult setUp(Site& site, Interview& person, const std::string& robots);

/// One page with pictures, as HTML.
std::string reportOf(const SetupResult& result);

/// The ten seconds before a drive.
struct PreDrive {
  std::vector<WiringFault> faults;
  std::string problem;  ///< why nothing could be said; empty
};

/// Drives less than a metre with a robot's configuration and names every part that is swapped,
/// reversed, dead or turned; throws ConfigError for a folder that is none.
PreDrive preDriveOf(Site& site, const std::string& folder);

}  // namespace tread::setup
