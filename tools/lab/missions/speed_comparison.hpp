// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/missions/report.hpp"

namespace tread::missions {

/// The same missions with different speed methods: always fast, always slow, by the seen ground,
/// the felt ground, or both.
struct SpeedComparison {
  std::vector<MissionBatch> batches;  ///< one per method, named after it
};

/// The robot's configuration with one of speedMethods().
RobotConfig withSpeedBy(const std::string& method, RobotConfig robot);
const std::vector<std::string>& speedMethods();

/// Shock, speed and time by ground, one line per method, with 95 % intervals over the missions.
void printSpeeds(std::ostream& out, const SpeedComparison& comparison);

/// The same with all missions; throws std::runtime_error with one line if it cannot be written.
void writeSpeeds(const std::string& path, const SpeedComparison& comparison);

}  // namespace tread::missions
