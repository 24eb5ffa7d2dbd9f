// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/motor_messages.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/blank.hpp"

namespace tread::motor {
namespace {

/// Keeps MOTOR and EXECUTION below their size limits, whatever an operator wrote as his reason.
constexpr size_t kMaxReason = 120;

ProgramSlot fromMessage(const program_slot_t& message) {
  ProgramSlot slot;
  slot.execution_id = message.execution_id;
  slot.pattern_id = message.slot_pattern_id;
  slot.set_version = message.slot_set_version;
  slot.kind = static_cast<CommandKind>(message.command_kind);
  slot.period_us = message.period;
  slot.series.reserve(message.left.size());
  for (size_t i = 0; i < message.left.size(); ++i)
    slot.series.push_back({message.left[i], message.right[i]});
  return slot;
}

int16_t toMessage(State state) {
  switch (state) {
    case State::kDriving:
      return motor_t::STATE_DRIVING;
    case State::kArmed:
      return motor_t::STATE_ARMED;
    case State::kStopping:
      return motor_t::STATE_STOPPING;
    case State::kDisarmed:
      return motor_t::STATE_DISARMED;
    case State::kFault:
      return motor_t::STATE_FAULT;
    case State::kEstopped:
      return motor_t::STATE_ESTOP;
  }
  return motor_t::STATE_FAULT;
}

std::string reasonOf(const FailsafeOutputs& failsafe) {
  const std::string& standing = failsafe.standing_fault;
  const bool told = standing.empty() || failsafe.reason.find(standing) != std::string::npos;
  const std::string reason = told ? failsafe.reason : failsafe.reason + "; now: " + standing;
  return reason.substr(0, kMaxReason);
}

}  // namespace

Program fromMessage(const program_t& message) {
  Program program;
  program.utime = message.utime;
  program.seq = message.seq;
  program.run_id = message.run_id;
  program.lease_us = message.lease;
  program.running = fromMessage(message.running);
  program.next = fromMessage(message.next);
  return program;
}

InsNotice fromMessage(const ins_t& message) {
  const int32_t blind = ins_t::STATUS_NO_POSITION | ins_t::STATUS_NO_HEADING;
  const bool finite = std::isfinite(message.position[0]) && std::isfinite(message.position[1]) &&
                      std::isfinite(message.orientation[0]);
  return {message.utime, (message.ins_status & blind) == 0 && finite};
}

execution_record_t toMessage(const ExecutionRecord& record) {
  auto message = blank<execution_record_t>();
  message.record_run_id = record.run_id;
  message.record_execution_id = record.execution_id;
  message.record_pattern_id = record.pattern_id;
  message.record_set_version = record.set_version;
  message.started = record.start_utime;
  message.ended = record.end_utime;
  message.commands_played = record.commands_played;
  message.commands_total = record.commands_total;
  message.outcome = static_cast<int16_t>(record.outcome);
  message.outcome_reason = record.reason.substr(0, kMaxReason);
  return message;
}

motor_t toMessage(const BridgeOutput& output, const MotorTelemetry& telemetry) {
  auto message = blank<motor_t>();
  message.motor_run_id = output.run_id;
  message.execution_id = output.execution_id;
  message.command_index = output.command_index;
  message.bridge_state = toMessage(output.failsafe.state);
  message.state_reason = reasonOf(output.failsafe);
  message.motor_command_kind = static_cast<int16_t>(output.kind);
  message.command_left = static_cast<float>(output.command.left);
  message.command_right = static_cast<float>(output.command.right);
  message.device_fault = telemetry.device_flags;
  message.battery_voltage = static_cast<float>(telemetry.battery_voltage);
  message.current_left = static_cast<float>(telemetry.current_left);
  message.current_right = static_cast<float>(telemetry.current_right);
  message.track_speed_left = static_cast<float>(telemetry.speed_left);
  message.track_speed_right = static_cast<float>(telemetry.speed_right);
  return message;
}

}  // namespace tread::motor
