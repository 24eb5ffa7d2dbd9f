// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>

#include <tread/execution_t.hpp>
#include <tread/ins_t.hpp>
#include <tread/program_t.hpp>

#include "common/messages/pattern_messages.hpp"
#include "modules/motor_bridge/core/program.hpp"
#include "modules/motor_bridge/core/series_player.hpp"

namespace tread::motor {

/// A slot in the planner's format.
inline program_slot_t toMessage(const ProgramSlot& slot) {
  program_slot_t message{};
  message.execution_id = slot.execution_id;
  message.slot_pattern_id = slot.pattern_id;
  message.slot_set_version = slot.set_version;
  for (const CommandKind kind : slot.kinds)
    message.channel_kind.push_back(static_cast<int16_t>(kind));
  message.num_channels = static_cast<int32_t>(slot.kinds.size());
  message.period = static_cast<int32_t>(slot.period_us);
  message.num_commands = static_cast<int32_t>(slot.series.size());
  for (const Command& command : slot.series) {
    std::vector<float>& values = message.command.emplace_back();
    for (size_t i = 0; i < slot.kinds.size(); ++i) values.push_back(static_cast<float>(command[i]));
  }
  return message;
}

inline program_t toMessage(const Program& program) {
  program_t message{};
  message.utime = program.utime;
  message.seq = program.seq;
  message.run_id = program.run_id;
  message.lease = static_cast<int32_t>(program.lease_us);
  message.running = toMessage(program.running);
  message.next = toMessage(program.next);
  return message;
}

/// A valid measurement at the origin.
inline ins_t makeIns(int64_t utime, int64_t seq) {
  ins_t message{};
  message.utime = utime;
  message.seq = seq;
  message.orientation[0] = 1.0;
  return message;
}

/// The newest record, with the fields that a planner needs.
inline std::optional<ExecutionRecord> newest(const execution_t& message) {
  if (message.records.empty()) return std::nullopt;
  return recordFrom(message.records.back());
}

}  // namespace tread::motor
