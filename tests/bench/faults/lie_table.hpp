// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tests/bench/faults/fault_run.hpp"

namespace tread::faults {

/// An input of the robot, and a way in which it can be wrong.
struct Lie {
  const char* input;
  const char* way;  ///< silent, frozen, delayed, lying, mirrored
  Fault fault;
};

/// All cases that can be measured in a mission.
std::vector<Lie> lies();

/// Worst effect of a lie.
struct LieFigures {
  int missions = 0;    ///< in which the robot moved at its beginning
  int stopped = 0;     ///< of these
  double after = 0.0;  ///< [s] until the motors were at zero for good
  double way = 0.0;    ///< [m] until standstill
  int collisions = 0;
  std::string reason;  ///< of the last stop
};

/// Drives the missions of these seeds with the lie from 7 s on.
LieFigures measure(const missions::RobotConfig& robot, const Lie& lie,
                   const std::vector<uint64_t>& seeds);

}  // namespace tread::faults
