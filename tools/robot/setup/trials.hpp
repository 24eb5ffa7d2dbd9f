// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "modules/commissioning/core/wiring_drive.hpp"
#include "tools/robot/setup/direct_robot.hpp"
#include "tools/robot/setup/interview.hpp"

namespace tread::setup {

/// Result for one side on the stand; NaN = the controller does not measure it.
struct LiftedSide {
  double dead_power = 0.0;  ///< [1] least share of the full command that moved it
  double current = 0.0;     ///< [A] running free at kLiftedLevel
};

/// Wheels up: result for each side.
struct LiftReport {
  std::array<LiftedSide, 2> sides;  ///< configured left and right
  commissioning::SideMotion seen;   ///< what a person saw the configured left side do
  std::vector<std::string> problems;
};

/// Level at which a side runs free on the stand.
inline constexpr double kLiftedLevel = 0.4;

/// Turns each side alone, tests the watchdog, and asks which one turned first and in which
/// direction.
/** Throws std::runtime_error, one line, if it cannot continue. */
LiftReport tryWheelsUp(Site& site, Interview& person, const Drivers& drivers);

/// Wheels down: result of the minute in the free circle.
struct GroundReport {
  commissioning::WiringReport wiring;
  std::vector<TimedCommand> commands;
  std::vector<TimedPose> fixes;
  double watchdog = 0.0;  ///< [s] from the last command to standstill of the INS; 0 = not tested
  std::string problem;    ///< why it ended early; empty if it did not
};

/// Drives the wiring test; `watchdog`: afterwards also stops sending while driving.
GroundReport tryWheelsDown(Site& site, const Drivers& drivers,
                           const commissioning::WiringDriveConfig& how,
                           const commissioning::WiringExpectation& expected, bool watchdog);

/// Applies the findings to the configuration: channels, directions, mounting of the INS.
void applyWiring(const commissioning::WiringReport& wiring, RobotFindings& findings);

}  // namespace tread::setup
