// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/execution_messages.hpp"

#include <cmath>

#include "common/messages/blank.hpp"
#include "common/report/text.hpp"

namespace tread {
namespace {

BridgeReading::State stateFrom(int16_t state) {
  using State = BridgeReading::State;
  // The same states in the same order.
  static_assert(static_cast<int16_t>(State::kArmed) == motor_t::STATE_ARMED);
  static_assert(static_cast<int16_t>(State::kDriving) == motor_t::STATE_DRIVING);
  static_assert(static_cast<int16_t>(State::kStopping) == motor_t::STATE_STOPPING);
  static_assert(static_cast<int16_t>(State::kEstopped) == motor_t::STATE_ESTOP);
  const bool known = state >= motor_t::STATE_DISARMED && state <= motor_t::STATE_ESTOP;
  return known ? static_cast<State>(state) : State::kDisarmed;
}

/// Far more than the eight that are repeated.
constexpr size_t kRememberedKeys = 64;
/// No queue of waiting executions is this long unless somebody sends nonsense.
constexpr size_t kMaxWaiting = 64;
/// An execution that is over does not end later than this after now [us].
constexpr int64_t kMaxAheadUs = 1'000'000;

/// Half a minute at 50 Hz.
constexpr size_t kRememberedCommands = 1500;
/// MOTOR carries single precision, and a Roboteq takes thousandths of full power.
constexpr double kTolerance = 2e-3;

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

bool mayDrive(int16_t bridge_state) {
  BridgeReading reading;
  reading.state = stateFrom(bridge_state);
  return reading.armed();
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

void ExecutionQueue::add(const execution_t& message, int64_t now) {
  for (const execution_record_t& record : message.records) {
    if (record.outcome == execution_record_t::OUTCOME_RUNNING) continue;
    const ExecutionKey key{record.record_run_id, record.record_execution_id};
    if (known_.count(key) > 0) continue;
    const bool sense =
        record.started > 0 && record.ended >= record.started && record.ended <= now + kMaxAheadUs;
    if (!sense || waiting_.size() >= kMaxWaiting) {
      ++invalid_;
      continue;
    }
    known_.insert(key);
    waiting_[{record.ended, key.first, key.second}] = record;
  }
}

std::optional<int64_t> ExecutionQueue::nextEnd() const {
  if (waiting_.empty()) return std::nullopt;
  return waiting_.begin()->second.ended;
}

std::optional<execution_record_t> ExecutionQueue::takeEndedBy(int64_t horizon) {
  if (waiting_.empty() || waiting_.begin()->second.ended > horizon) return std::nullopt;
  execution_record_t record = waiting_.begin()->second;
  waiting_.erase(waiting_.begin());
  noteHandled({record.record_run_id, record.record_execution_id});
  return record;
}

void ExecutionQueue::remember(const std::vector<ExecutionKey>& handled) {
  for (const ExecutionKey& key : handled) {
    known_.insert(key);
    noteHandled(key);
  }
}

void ExecutionQueue::noteHandled(const ExecutionKey& key) {
  order_.push_back(key);
  while (order_.size() > kRememberedKeys) {
    known_.erase(order_.front());
    order_.pop_front();
  }
}

void CommandWatch::add(const motor_t& motor) {
  if (motor.execution_id == 0 || motor.command_index < 0) return;
  given_.push_back({{motor.motor_run_id, motor.execution_id},
                    motor.command_index,
                    motor.motor_command_kind,
                    static_cast<double>(motor.command_left),
                    static_cast<double>(motor.command_right)});
  if (given_.size() > kRememberedCommands) given_.pop_front();
}

std::string CommandWatch::unexpectedCommand(const ExecutionKey& execution,
                                            const MotionPattern& pattern, CommandKind kind) const {
  for (const Given& given : given_) {
    if (given.execution != execution) continue;
    if (given.kind != static_cast<int16_t>(kind))
      return "the motors got another kind of command than the pattern has";
    const auto index = static_cast<size_t>(given.index);
    if (index >= pattern.commands.size())
      return "the motors got more commands than the pattern has";
    const TrackCommand& command = pattern.commands[index];
    // Both by themselves: a NaN in one of them must not hide behind the other.
    if (std::abs(given.left - command.left) <= kTolerance &&
        std::abs(given.right - command.right) <= kTolerance)
      continue;
    return formatted("command %zu was (%.3f, %.3f) on the motors, (%.3f, %.3f) in the pattern",
                     index, given.left, given.right, command.left, command.right);
  }
  return {};
}

}  // namespace tread
