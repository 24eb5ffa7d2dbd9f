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

/// A check whether two related values fit.
struct FitCheck {
  bool good = true;
  std::string words;  ///< one line: what, with numbers; the remedy if it does not fit
};

/// Results of a setup; `problem`: why it stopped, one line.
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

/// Sets up a robot: ports, wiring, motion, patterns, first goal; writes its folder below `robots`.
/// A failure of the robot does not throw but is the result's problem.
SetupResult setUp(Site& site, Interview& person, const std::string& robots);

/// Result of the 10 s test before a drive.
struct PreDrive {
  std::vector<commissioning::WiringFault> faults;
  std::string problem;  ///< why there is no result; empty = valid
};

/// Drives less than a metre with a robot's configuration and reports every part that is swapped,
/// reversed, dead or turned; throws ConfigError for an invalid folder.
PreDrive preDriveOf(Site& site, const std::string& folder);

}  // namespace tread::setup
