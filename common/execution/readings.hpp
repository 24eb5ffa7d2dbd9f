// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/se2.hpp"

namespace tread {

/// (run id, execution id): names one execution for ever.
using ExecutionKey = std::pair<int64_t, int64_t>;

/// Where the vehicle was measured to be.
struct PoseReading {
  int64_t utime = 0;  ///< [us] of the measurement
  Pose2 T_map_body;
  std::optional<Twist2> twist;  ///< v_body, if it is measured
};

/// What the motor bridge says it does.
struct BridgeReading {
  enum class State { kDisarmed, kArmed, kDriving, kStopping, kFault, kEstopped };
  int64_t utime = 0;  ///< [us] when it gave its last command
  State state = State::kDisarmed;
  std::string reason;
  int64_t run_id = 0;
  int64_t execution_id = 0;  ///< being played; 0 = none
  int command_index = -1;

  /// It may drive without being armed anew.
  bool armed() const {
    return state == State::kArmed || state == State::kDriving || state == State::kStopping;
  }
};

/// One execution as the motor bridge records it.
struct ExecutionReading {
  enum class State { kRunning, kCompleted, kAborted };
  int64_t run_id = 0;
  int64_t execution_id = 0;
  int64_t started = 0;  ///< [us]
  State state = State::kRunning;
  std::string reason;  ///< why aborted
};

/// What whoever drives the robot knows about it at one moment.
struct RobotReadings {
  int64_t now = 0;  ///< [us]
  std::optional<PoseReading> pose;
  std::optional<BridgeReading> bridge;
  std::vector<ExecutionReading> executions;  ///< the last ones, oldest first
  bool armed_by_operator = false;            ///< ARM came since the start and since the last stop
  bool estopped = false;
};

}  // namespace tread
