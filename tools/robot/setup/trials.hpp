// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/robot/setup/core/wiring_drive.hpp"
#include "tools/robot/setup/direct_robot.hpp"
#include "tools/robot/setup/interview.hpp"

namespace tread::setup {

/// What one side did on the stand; NaN = the controller does not tell.
struct LiftedSide {
  double dead_power = 0.0;  ///< [1] least share of the full command that moved it
  double current = 0.0;     ///< [A] running free at kLiftedLevel
};

/// Wheels up: each side alone.
struct LiftReport {
  std::array<LiftedSide, 2> sides;  ///< configured left and right
  SideMotion seen;                  ///< what a person saw of the configured left side
  std::vector<std::string> problems;
};

/// Level at which a side runs free on the stand.
inline constexpr double kLiftedLevel = 0.4;

/// Turns each side alone, lets the watchdog trip, and asks which one turned first, and how.
/** Throws std::runtime_error, one line, where it cannot go on. */
LiftReport tryWheelsUp(Site& site, Interview& person, const Drivers& drivers);

/// Wheels down: the minute in the free circle.
struct GroundReport {
  WiringReport wiring;
  std::vector<GivenCommand> commands;
  std::vector<InsFix> fixes;
  double watchdog = 0.0;  ///< [s] from the last command to standing, by the INS; 0 = not tried
  std::string problem;    ///< why it ended early; empty if it did not
};

/// Drives the wiring out; `watchdog`: then also ceases to command while it drives.
GroundReport tryWheelsDown(Site& site, const Drivers& drivers, const WiringDriveConfig& how,
                           const WiringExpectation& expected, bool watchdog);

/// Applies what was found to what is configured: channels, directions, mounting of the INS.
void applyWiring(const WiringReport& wiring, RobotFindings& findings);

}  // namespace tread::setup
