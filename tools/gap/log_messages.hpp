// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"
#include "modules/identification/core/drive.hpp"

namespace tread::gap {

/// When a message was logged, what time it says itself, and its number.
struct Stamp {
  int64_t logged = 0;  ///< [us] of the recorder's clock
  int64_t utime = 0;   ///< [us] of the robot's clock
  int64_t seq = 0;
};

/// Whether a number follows another one directly; any bytes may stand in a log.
inline bool isNext(int64_t seq, int64_t before) {
  return static_cast<uint64_t>(seq) - static_cast<uint64_t>(before) == 1;
}

/// What the gap workflow reads of a log.
struct LogMessages {
  std::vector<motor_t> motor;                  ///< in order of utime
  std::vector<ins_t> ins;                      ///< in order of utime
  std::vector<execution_record_t> executions;  ///< completed ones, each once, in order of begin
  std::vector<Stamp> motor_stamps;             ///< in the order of the log
  std::vector<Stamp> ins_stamps;               ///< in the order of the log
  size_t motor_clashes = 0;  ///< neighbours in the log with one time and different commands
  size_t ins_clashes = 0;    ///< neighbours in the log with one time and different places
  /// By process: boot ids as they follow each other in the log, without repetition.
  std::map<std::string, std::vector<int64_t>> boots;
  std::optional<ImportNote> imported;  ///< the last one
  int64_t origin = 0;  ///< [us] utime of the first INS or MOTOR; time 0 of the drive
  size_t events = 0;   ///< in the log, whatever their channel
  size_t foreign = 0;  ///< on our channels, but of another type or time

  /// Seconds since time 0.
  double seconds(int64_t utime) const { return 1e-6 * static_cast<double>(utime - origin); }
};

/// Decodes and sorts the events of a log.
LogMessages sortMessages(const std::vector<LogEvent>& events);

}  // namespace tread::gap
