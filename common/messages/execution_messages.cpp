// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/execution_messages.hpp"

#include "common/messages/blank.hpp"

namespace tread {
namespace {

BridgeReading::State stateFrom(int16_t state) {
  switch (state) {
    case motor_t::STATE_ARMED:
      return BridgeReading::State::kArmed;
    case motor_t::STATE_DRIVING:
      return BridgeReading::State::kDriving;
    case motor_t::STATE_STOPPING:
      return BridgeReading::State::kStopping;
    case motor_t::STATE_FAULT:
      return BridgeReading::State::kFault;
    case motor_t::STATE_ESTOP:
      return BridgeReading::State::kEstopped;
    default:
      return BridgeReading::State::kDisarmed;
  }
}

}  // namespace

BridgeReading readingFrom(const motor_t& message) {
  BridgeReading reading;
  reading.utime = message.utime;
  reading.state = stateFrom(message.bridge_state);
  reading.reason = message.state_reason;
  reading.run_id = message.motor_run_id;
  reading.execution_id = message.execution_id;
  reading.command_index = message.command_index;
  return reading;
}

std::vector<ExecutionReading> readingsFrom(const execution_t& message) {
  std::vector<ExecutionReading> readings;
  for (const execution_record_t& record : message.records) {
    ExecutionReading reading;
    reading.run_id = record.record_run_id;
    reading.execution_id = record.record_execution_id;
    reading.started = record.started;
    if (record.outcome == execution_record_t::OUTCOME_COMPLETED)
      reading.state = ExecutionReading::State::kCompleted;
    if (record.outcome == execution_record_t::OUTCOME_ABORTED)
      reading.state = ExecutionReading::State::kAborted;
    reading.reason = record.outcome_reason;
    readings.push_back(reading);
  }
  return readings;
}

program_slot_t toMessage(const ProgramSlot& slot) {
  auto message = blank<program_slot_t>();
  if (slot.empty()) return message;
  const PatternSetContent& content = slot.set->content();
  message.execution_id = slot.execution_id;
  message.slot_pattern_id = slot.pattern_id;
  message.slot_set_version = slot.set->version();
  message.command_kind = static_cast<int16_t>(content.kind);
  message.period = static_cast<int32_t>(content.period_us);
  for (const TrackCommand& command : slot.pattern().commands) {
    message.left.push_back(static_cast<float>(command.left));
    message.right.push_back(static_cast<float>(command.right));
  }
  message.num_commands = static_cast<int32_t>(message.left.size());
  return message;
}

}  // namespace tread
