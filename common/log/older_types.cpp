// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/log/older_types.hpp"

#include <algorithm>
#include <iterator>

#include <tread_before/motor_t.hpp>
#include <tread_before/pattern_set_part_t.hpp>
#include <tread_before/program_t.hpp>

#include "common/execution/stop_reason.hpp"
#include "common/messages/blank.hpp"
#include "common/pattern/command.hpp"
#include "common/types/renewal.hpp"

namespace tread {
namespace {

motor_t renewed(const tread_before::motor_t& old) {
  auto message = blank<motor_t>();
  message.utime = old.utime;
  message.seq = old.seq;
  message.motor_run_id = old.motor_run_id;
  message.execution_id = old.execution_id;
  message.command_index = old.command_index;
  message.bridge_state = old.bridge_state;
  message.state_code = static_cast<int16_t>(stopReasonOf(old.state_reason));
  message.state_reason = old.state_reason;
  message.channel_kind[0] = message.channel_kind[1] = old.motor_command_kind;
  message.command[0] = old.command_left;
  message.command[1] = old.command_right;
  message.device_fault = old.device_fault;
  message.battery_voltage = old.battery_voltage;
  message.current[0] = old.current_left;
  message.current[1] = old.current_right;
  message.measured[0] = old.track_speed_left;
  message.measured[1] = old.track_speed_right;
  return message;
}

program_slot_t renewed(const tread_before::program_slot_t& old) {
  auto slot = blank<program_slot_t>();
  slot.execution_id = old.execution_id;
  slot.slot_pattern_id = old.slot_pattern_id;
  slot.slot_set_version = old.slot_set_version;
  slot.period = old.period;
  if (old.execution_id == 0) return slot;
  slot.num_commands = old.num_commands;
  slot.num_channels = 2;
  slot.channel_kind = {old.command_kind, old.command_kind};
  for (size_t i = 0; i < old.left.size(); ++i) slot.command.push_back({old.left[i], old.right[i]});
  return slot;
}

program_t renewed(const tread_before::program_t& old) {
  auto message = blank<program_t>();
  message.utime = old.utime;
  message.seq = old.seq;
  message.run_id = old.run_id;
  message.lease = old.lease;
  message.running = renewed(old.running);
  message.next = renewed(old.next);
  message.inputs_heard = old.inputs_heard;
  message.newest_input = old.newest_input;
  message.newest_input_utime = old.newest_input_utime;
  message.newest_input_seq = old.newest_input_seq;
  return message;
}

/// The two tracks and their ranges, implied in every older set.
void addTracks(int16_t kind, pattern_set_part_t& message) {
  message.num_channels = 2;
  for (const CommandChannel& channel : trackChannels(static_cast<CommandKind>(kind))) {
    message.channel_name.push_back(channel.name);
    message.channel_kind.push_back(kind);
    message.channel_lowest.push_back(channel.lowest);
    message.channel_highest.push_back(channel.highest);
  }
}

pattern_set_part_t renewed(const tread_before::pattern_set_part_t& old) {
  auto message = blank<pattern_set_part_t>();
  message.utime = old.utime;
  message.seq = old.seq;
  message.set_version = old.set_version;
  message.parent_version = old.parent_version;
  message.set_checksum = old.set_checksum;
  message.set_name = old.set_name;
  message.part = old.part;
  message.part_count = old.part_count;
  message.set_pattern_id = old.set_pattern_id;
  message.pattern_name = old.pattern_name;
  addTracks(old.set_command_kind, message);
  message.set_period = old.set_period;
  message.entry_class = old.entry_class;
  message.exit_class = old.exit_class;
  std::copy(std::begin(old.entry_twist), std::end(old.entry_twist), message.entry_twist);
  std::copy(std::begin(old.exit_twist), std::end(old.exit_twist), message.exit_twist);
  message.entry_steady.assign(std::begin(old.entry_steady), std::end(old.entry_steady));
  message.exit_steady.assign(std::begin(old.exit_steady), std::end(old.exit_steady));
  message.num_samples = old.num_samples;
  message.command = old.command;
  message.trajectory = old.trajectory;
  std::copy(std::begin(old.end_covariance), std::end(old.end_covariance), message.end_covariance);
  message.times_learned = old.times_learned;
  return message;
}

template <class Old, class Message>
void renewOne(LogEvent& event, const Channel<Message>& channel) {
  Old old{};
  if (decode(event, Channel<Old>{channel}, old)) event.bytes = encoded(renewed(old));
}

}  // namespace

void renew(LogEvent& event) {
  if (renewByNames(event.channel, event.bytes)) return;
  renewOne<tread_before::motor_t>(event, kMotor);
  renewOne<tread_before::program_t>(event, kProgram);
  renewOne<tread_before::pattern_set_part_t>(event, kPatternSet);
}

}  // namespace tread
