// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

#include "modules/motor_bridge/core/bridge.hpp"
#include "tests/motor_bridge/endless_planner.hpp"

namespace tread::motor {

/// The newest record of a log; nullopt if it is empty.
inline std::optional<ExecutionRecord> newest(const ExecutionLog& log) {
  return log.records().empty() ? std::nullopt : std::optional(log.records().back());
}

/// A bridge with a planner at 20 Hz and an INS at 50 Hz in virtual time; each may fall silent.
struct BridgeWorld {
  Bridge bridge{BridgeConfig{}};
  EndlessPlanner planner;
  DeviceReport device;
  BridgeOutput out;
  int64_t now = 10'000'000;
  bool planner_alive = true;
  bool ins_alive = true;
  bool operator_alive = true;
  int64_t ins_seq = 0;
  int64_t view_age = 10'000;  ///< [us] age of the operator's view
  InsMotion motion;           ///< measured by the INS
  InsTilt tilt;

  static constexpr int64_t kStep = 10'000;

  void step() {
    now += kStep;
    motion.utime = tilt.utime = now - 5'000;
    if (ins_alive && now % 20'000 == 0)
      bridge.receive(InsNotice{now - 5'000, true, motion, ins_seq++, tilt}, now);
    if (planner_alive && now % 50'000 == 0)
      bridge.receive(planner.plan(now - 1'000, newest(bridge.executions())), now);
    if (operator_alive && now % 200'000 == 0)
      bridge.receive(OperatorNotice{1, "operator", true, now - view_age, 0, ""}, now);
    out = bridge.step(now, device);
  }
  void run(int64_t us) {
    for (const int64_t end = now + us; now < end;) step();
  }
  void arm() { bridge.receive(ArmRequest{now, true, "operator", "go"}, now); }
  /// Runs until the bridge drives.
  void drive() {
    run(1'200'000);
    arm();
    run(200'000);
  }
  BridgeState state() const { return out.failsafe.state; }
  const std::string& reason() const { return out.failsafe.reason; }
  const ExecutionRecord& last() const { return bridge.executions().records().back(); }
};

}  // namespace tread::motor
