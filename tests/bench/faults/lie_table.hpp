// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tests/bench/faults/fault_run.hpp"

namespace tread::faults {

/// An input that the robot believes, and a way in which it can be wrong.
struct Lie {
  const char* input;
  const char* way;  ///< silent, frozen, delayed, lying, mirrored
  Fault fault;
};

/// All that can be measured in a mission.
std::vector<Lie> lies();

/// The worst of what came of a lie.
struct LieFigures {
  int missions = 0;    ///< in which the robot moved when it began
  int stopped = 0;     ///< of these
  double after = 0.0;  ///< [s] until the motors were at zero for good
  double way = 0.0;    ///< [m] until it stood
  int collisions = 0;
  std::string reason;  ///< of the last stop
};

/// Drives missions of these seeds in which the lie begins after 7 s and lasts.
LieFigures measure(const missions::RobotConfig& robot, const Lie& lie,
                   const std::vector<uint64_t>& seeds);

}  // namespace tread::faults
