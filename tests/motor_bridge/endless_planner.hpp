// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <utility>

#include "modules/motor_bridge/core/series_player.hpp"
#include "tests/motor_bridge/programs.hpp"

namespace tread::motor {

/// A planner that drives for ever: always a running and a next slot, following the executions.
class EndlessPlanner {
 public:
  explicit EndlessPlanner(int64_t run_id = 1) : run_id_(run_id) {}

  /// Program for now [us], from the newest execution that the bridge reported.
  Program plan(int64_t now, const std::optional<ExecutionRecord>& last) {
    if (running_.empty() && !stands) {
      running_ = fresh();
      next_ = fresh();
    }
    if (last && last->run_id == run_id_) follow(*last);
    if (stands) running_ = next_ = ProgramSlot{};
    Program program = makeProgram(now, running_, endless ? next_ : ProgramSlot{});
    program.run_id = run_id_;
    return program;
  }
  int commands = 8;     ///< per slot from now on, 50 ms each
  bool endless = true;  ///< false: has no next slot
  bool stands = false;  ///< true: its programs are empty
  double least_power = 0.2;
  std::optional<Command> always;                 ///< a constant power in each slot
  std::function<ProgramSlot(int64_t id)> slots;  ///< or these slots
  double right = -1.0;  ///< power of the right track relative to the left one's

 private:
  void follow(const ExecutionRecord& last) {
    if (last.outcome != ExecutionOutcome::kRunning && last.execution_id >= running_.execution_id) {
      running_ = fresh();
      next_ = fresh();
    } else if (last.execution_id == next_.execution_id) {
      running_ = std::exchange(next_, fresh());
    }
  }
  ProgramSlot fresh() {
    ++id_;
    if (slots) return slots(id_);
    if (always) return makeSlot(id_, commands, (*always)[0], (*always)[1]);
    const double power = least_power + 0.01 * static_cast<double>(id_ % 50);
    return makeSlot(id_, commands, power, right * power);
  }

  int64_t run_id_;
  int64_t id_ = 0;
  ProgramSlot running_;
  ProgramSlot next_;
};

}  // namespace tread::motor
