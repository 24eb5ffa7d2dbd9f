// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "common/execution/stop_reason.hpp"
#include "lcmtypes/enums.hpp"

namespace tread {

/// One execution as it really took place, as the motor bridge records it.
struct ExecutionRecord {
  int64_t run_id = 0;
  int64_t execution_id = 0;
  int32_t pattern_id = 0;
  int64_t set_version = 0;
  int64_t started = 0;          ///< [us] when the first command was due
  int64_t ended = -1;           ///< [us] end of the last period, or of the abort; -1 = running
  int32_t commands_played = 0;  ///< actually given to the controller
  int32_t commands_total = 0;
  ExecutionOutcome outcome = ExecutionOutcome::kRunning;
  Reason reason;  ///< why aborted; otherwise none

  bool completed() const { return outcome == ExecutionOutcome::kCompleted; }
};

}  // namespace tread
