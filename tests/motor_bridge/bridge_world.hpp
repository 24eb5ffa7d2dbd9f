// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "modules/motor_bridge/core/bridge.hpp"
#include "tests/motor_bridge/programs.hpp"

namespace tread::motor {

/// A planner that drives for ever: always a running and a next slot, led by the execution log.
class EndlessPlanner {
 public:
  explicit EndlessPlanner(int64_t run_id = 1) : run_id_(run_id) {}

  /// Program of now [us], from what the bridge last reported.
  Program plan(int64_t now, const ExecutionLog& log) {
    follow(log);
    Program program = makeProgram(now, running_, next_);
    program.run_id = run_id_;
    return program;
  }
  /// Commands of the slots from now on; 8 commands of 50 ms by default.
  int commands = 8;

 private:
  void follow(const ExecutionLog& log) {
    if (running_.empty()) {
      running_ = fresh();
      next_ = fresh();
    }
    if (log.records().empty() || log.records().back().run_id != run_id_) {
      return;
    }
    const ExecutionRecord& last = log.records().back();
    if (last.outcome != Outcome::kRunning && last.execution_id >= running_.execution_id) {
      running_ = fresh();
      next_ = fresh();
    } else if (last.execution_id == next_.execution_id) {
      running_ = std::exchange(next_, fresh());
    }
  }
  Slot fresh() {
    ++id_;
    const double power = 0.2 + 0.01 * static_cast<double>(id_ % 50);
    return makeSlot(id_, commands, power, -power);
  }

  int64_t run_id_;
  int64_t id_ = 0;
  Slot running_;
  Slot next_;
};

/// A bridge with a planner at 20 Hz and an INS at 50 Hz in virtual time; each may fall silent.
struct BridgeWorld {
  Bridge bridge{BridgeConfig{}};
  EndlessPlanner planner;
  DeviceReport device;
  BridgeOutput out;
  int64_t now = 10'000'000;
  bool planner_alive = true;
  bool ins_alive = true;

  static constexpr int64_t kStep = 10'000;

  void step() {
    now += kStep;
    if (ins_alive && now % 20'000 == 0) {
      bridge.receive(InsNotice{now - 5'000, true}, now);
    }
    if (planner_alive && now % 50'000 == 0) {
      bridge.receive(planner.plan(now - 1'000, bridge.executions()), now);
    }
    out = bridge.step(now, device);
  }
  void run(int64_t us) {
    for (const int64_t end = now + us; now < end;) {
      step();
    }
  }
  void arm() { bridge.receive(ArmRequest{now, true, "operator", "go"}, now); }
  /// Runs until the bridge drives.
  void drive() {
    run(1'200'000);
    arm();
    run(200'000);
  }
  State state() const { return out.failsafe.state; }
  const std::string& reason() const { return out.failsafe.reason; }
  const ExecutionRecord& last() const { return bridge.executions().records().back(); }
};

}  // namespace tread::motor
