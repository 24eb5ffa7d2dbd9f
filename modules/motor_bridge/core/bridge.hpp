// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/execution/operator_lease.hpp"
#include "common/execution/stopping_time.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/core/failsafe.hpp"
#include "modules/motor_bridge/core/fence_watch.hpp"
#include "modules/motor_bridge/core/manual_control.hpp"
#include "modules/motor_bridge/core/motion_monitor.hpp"
#include "modules/motor_bridge/core/motor_controller.hpp"
#include "modules/motor_bridge/core/program.hpp"
#include "modules/motor_bridge/core/series_player.hpp"

namespace tread::motor {

/// Configuration of the bridge.
struct BridgeConfig {
  int64_t step_us = 10'000;              ///< period of step() [us]
  int64_t command_interval_us = 20'000;  ///< interval at which a command is repeated [us]
  int64_t idle_interval_us = 100'000;    ///< of zero, some time after a stop [us]
  int64_t max_stall_us = 100'000;        ///< longest gap between steps [us]
  GateLimits gate;
  InsLimits ins;
  OperatorRules operators;
  MotionLimits motion;
  std::optional<TiltLimits> tilt;  ///< nothing: not watched
  FenceLimits fences;
  ManualLimits manual;
};

/// What a step decided.
struct BridgeOutput {
  FailsafeOutputs failsafe;
  Command command;                   ///< zero unless driving
  bool send = false;                 ///< send the command to the controller now
  std::vector<CommandKind> kinds;    ///< of the series played, or of manual control
  int64_t run_id = 0;                ///< of the series played; 0 = none
  int64_t execution_id = 0;          ///< being played; 0 = none
  int32_t command_index = -1;        ///< in the series; -1 = none
  bool hold_device_stop = false;     ///< engage the controller's own emergency stop
  bool release_device_stop = false;  ///< ... and release it
};

/// The last process before the motors, as a pure core: messages in, commands out, time as an
/// argument.
class Bridge {
 public:
  explicit Bridge(const BridgeConfig& config);

  /// Messages as received, now [us] on the clock of step().
  void receive(const Program& program, int64_t now);
  void receive(const ArmRequest& request, int64_t now);
  void receive(const EstopRequest& request, int64_t now);
  void receive(const InsNotice& notice, int64_t now);
  void receive(const OperatorNotice& notice, int64_t now);
  void receive(const FenceRequest& request, int64_t now);
  void receive(const ManualNotice& notice, int64_t now);
  void receive(const MotorTelemetry& motors) { motion_.receive(motors); }

  /// Decides what the motors do from now [us] on.
  BridgeOutput step(int64_t now, const DeviceReport& device);

  const StoppingTime& stopping() const { return stopping_; }
  /// Who holds the robot; empty = nobody.
  const std::string& holder() const { return operator_.holder(); }
  const FenceBook& fences() const { return fences_.book(); }
  const ExecutionLog& executions() const { return player_.log(); }
  /// How often something was refused or noted, by its name in words.
  const std::map<std::string, int64_t>& counters() const { return counters_; }

 private:
  /// Inputs since the last step.
  struct Since {
    bool arm = false;
    bool disarm = false;
    bool estop_cleared = false;
    bool planner_stop = false;
    ArmRequest request;
    std::string refusal;
    Reason program_fault;
  };

  void count(const std::string& what) { ++counters_[what]; }
  void take(const Program& program, int64_t now);
  void adoptLatchedStop(int64_t now, const DeviceReport& device);
  Reason stallFault(int64_t now) const;
  Reason leaseFault(int64_t now) const;
  bool mayGoOn(int64_t silent) const;
  void lookForOperator(int64_t now, FailsafeInputs& in);
  void lookForHand(int64_t now, FailsafeInputs& in);
  Reason moveSchedule(int64_t now, bool stalled);
  FailsafeInputs look(int64_t now, const DeviceReport& device);
  void command(int64_t now, BridgeOutput& out);
  void schedule(int64_t now, BridgeOutput& out);

  BridgeConfig config_;
  ProgramGate gate_;
  SeriesPlayer player_;
  InsWatch ins_;
  MotionMonitor motion_;
  TiltWatch tilt_;
  FenceWatch fences_;
  StoppingTime stopping_;
  OperatorRequests requests_;
  bool controller_met_ = false;  ///< it has answered at least once
  OperatorLease operator_;
  ManualControl manual_;
  std::optional<int64_t> operator_lost_;  ///< [us] since when
  Failsafe failsafe_;
  Since since_;
  std::optional<int64_t> last_step_;
  std::optional<int64_t> last_sent_;
  Command sent_;
  int64_t moved_at_ = 0;  ///< [us] of the newest command that is not zero
  std::map<std::string, int64_t> counters_;
};

}  // namespace tread::motor
