// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/drive/drive_reader.hpp"

namespace tread {

/// When a message was logged, what time it says itself, and its number.
struct Stamp {
  int64_t logged = 0;  ///< [us] of the recorder's clock
  int64_t utime = 0;   ///< [us] of the robot's clock
  int64_t seq = 0;
};

/// Whether a tile can be one of a robot's map: a log has no checksums, and a bus has strangers.
bool isPossibleTile(const map_tile_t& tile);

/// (run id, execution id).
using ExecutionKey = std::pair<int64_t, int64_t>;
inline ExecutionKey keyOf(const execution_record_t& record) {
  return {record.record_run_id, record.record_execution_id};
}

/// What a log holds about a drive: commands, measurements, executions and notes, each in the order
/// in which they were recorded. Messages that cannot be decoded or claim an impossible time are
/// left out; `notes` counts them.
struct DriveLog {
  std::string name;                ///< file name without folder
  std::string problem;             ///< all that is wrong with the log in one line: damage, notes
  std::string damage;              ///< one clear line if the log is damaged; the rest was read
  std::vector<std::string> notes;  ///< what else is wrong with it, see DriveReader
  std::vector<LogEvent> events;    ///< all of the log, whatever their channel, in robot's time
  std::vector<motor_t> motor;      ///< MOTOR: the commands as applied
  std::vector<ins_t> ins;          ///< INS
  std::vector<Stamp> motor_stamps, ins_stamps;  ///< of the messages above
  std::vector<execution_record_t> executions;   ///< EXECUTION: those that ended, each once
  std::vector<config_t> configs;                ///< CONFIG
  std::map<int64_t, std::string> surfaces;      ///< MARK surface: from when on [us]

  /// The surface at a time; "unknown" before the first mark.
  std::string surfaceAt(int64_t utime) const;
};

/// Reads the drive of a recording (one file, or its parts in order); throws as DriveReader does.
DriveLog readDriveLog(const std::vector<std::string>& paths);
/// The same from events in memory, at the recorder's times; `name` stands for the file.
DriveLog toDriveLog(const std::string& name, std::vector<LogEvent> events);

/// Decodes an event if it is on one of the channels, and calls `hear` with the message; false if it
/// is on none or not of its type.
template <class Hear, class... Messages>
bool dispatch(const LogEvent& event, Hear&& hear, const Channel<Messages>&... channels) {
  const auto heard = [&](const auto& channel, const auto* type) {
    // Most events are on none of the channels: no message is made for them.
    if (event.channel != channel.name) return false;
    std::decay_t<decltype(*type)> message{};
    if (!decode(event, channel, message)) return false;
    hear(std::as_const(message));
    return true;
  };
  return (heard(channels, static_cast<const Messages*>(nullptr)) || ...);
}

/// Makes the log of a drive as a robot's logger would have recorded it: numbers the messages of
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

  /// An execution starts; publishes nothing yet. Its record, valid until the next one starts.
  execution_record_t& start(const execution_record_t& record);
  /// Publishes EXECUTION with the last executions.
  void publishExecutions(int64_t utime);

  /// The events in order of time; of one time in the order in which they were added.
  std::vector<LogEvent> sorted();

  /// Orientation of an INS message [rad].
  static void setAttitude(ins_t& ins, double yaw, double pitch = 0.0, double roll = 0.0);

 private:
  std::vector<LogEvent> events_;
  std::vector<execution_record_t> records_;  ///< the last ones, as EXECUTION repeats them
  std::map<std::string, int64_t> next_seq_;  ///< by channel
};

}  // namespace tread
