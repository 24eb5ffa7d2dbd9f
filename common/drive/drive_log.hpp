// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/drive/drive_reader.hpp"

namespace tread {

/// When a message was logged, its own time, and its number.
struct Stamp {
  int64_t logged = 0;  ///< [us] of the recorder's clock
  int64_t utime = 0;   ///< [us] of the robot's clock
  int64_t seq = 0;
};

/// Whether a tile can be one of a robot's map: logs have no checksums, and a bus may carry foreign
/// messages.
bool isPossibleTile(const map_tile_t& tile);

/// (run id, execution id).
using ExecutionKey = std::pair<int64_t, int64_t>;
inline ExecutionKey keyOf(const execution_record_t& record) {
  return {record.record_run_id, record.record_execution_id};
}

/// The contents of a drive's log: commands, measurements, executions and notes, each in the order
/// of recording. Messages that cannot be decoded or have an impossible time are left out; `notes`
/// counts them.
struct DriveLog {
  std::string name;                ///< file name without folder
  std::string problem;             ///< all problems of the log in one line: damage, notes
  std::string damage;              ///< one clear line if the log is damaged; the rest was read
  std::vector<std::string> notes;  ///< other problems, see DriveReader
  std::vector<LogEvent> events;    ///< the whole log, all channels, in robot time
  std::vector<motor_t> motor;      ///< MOTOR: the commands as applied
  std::vector<ins_t> ins;          ///< INS
  std::vector<Stamp> motor_stamps, ins_stamps;  ///< of the messages above
  std::vector<execution_record_t> executions;   ///< EXECUTION: the completed ones, each once
  std::vector<config_t> configs;                ///< CONFIG
  std::map<int64_t, std::string> surfaces;  ///< MARK surface: the surface from each time [us] on

  /// The surface at a time; "unknown" before the first mark.
  std::string surfaceAt(int64_t utime) const;
};

/// Reads the drive of a recording (one file, or its parts in order); throws as DriveReader does.
DriveLog readDriveLog(const std::vector<std::string>& paths);
/// The same from events in memory, at the recorder's times; `name` stands for the file.
DriveLog toDriveLog(const std::string& name, std::vector<LogEvent> events);

/// Decodes an event if it is on one of the channels, and calls `hear` with the message; false for
/// other channels and wrong types.
template <class Hear, class... Messages>
bool dispatch(const LogEvent& event, Hear&& hear, const Channel<Messages>&... channels) {
  const auto heard = [&](const auto& channel, const auto* type) {
    // Most events are on other channels: no message is constructed for them.
    if (event.channel != channel.name) return false;
    std::decay_t<decltype(*type)> message{};
    if (!decode(event, channel, message)) return false;
    hear(std::as_const(message));
    return true;
  };
  return (heard(channels, static_cast<const Messages*>(nullptr)) || ...);
}

/// Builds the log of a drive as a robot's logger would have recorded it: numbers the messages of
/// each channel and repeats the last eight executions, as motor_bridge does.
class DriveLogBuilder {
 public:
  /// Adds a message at its own utime; its seq is set.
  template <class Message>
  void add(const Channel<Message>& channel, Message message) {
    message.seq = next_seq_[channel.name]++;
    events_.push_back(eventOf(channel, message));
  }
  void addMark(int64_t utime, const std::string& kind, const std::string& value);
  void addConfig(int64_t utime, const std::string& process, int64_t boot_id,
                 const std::string& text);

  /// Starts an execution without publishing it. Returns its record, valid until the next start.
  execution_record_t& start(const execution_record_t& record);
  /// Publishes EXECUTION with the last executions.
  void publishExecutions(int64_t utime);

  /// The events in order of time; those of the same time in the order of adding.
  std::vector<LogEvent> sorted();

  /// Orientation of an INS message [rad].
  static void setAttitude(ins_t& ins, double yaw, double pitch = 0.0, double roll = 0.0);

 private:
  std::vector<LogEvent> events_;
  std::vector<execution_record_t> records_;  ///< the last ones, as EXECUTION repeats them
  std::map<std::string, int64_t> next_seq_;  ///< by channel
};

}  // namespace tread
