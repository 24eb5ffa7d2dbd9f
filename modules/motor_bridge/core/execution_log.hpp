// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <string>

#include "modules/motor_bridge/core/program.hpp"

namespace tread::motor {

/// How an execution went; the numbers are those of execution_record_t.
enum class Outcome : int16_t { kRunning = 0, kCompleted = 1, kAborted = 2 };

/// One execution as it really took place.
struct ExecutionRecord {
  int64_t run_id = 0;
  int64_t execution_id = 0;
  int32_t pattern_id = 0;
  int64_t set_version = 0;
  int64_t start_utime = 0;      ///< [us] when the first command was due
  int64_t end_utime = -1;       ///< [us] end of the last period, or of the abort; -1 = running
  int32_t commands_played = 0;  ///< that were really given to the controller
  int32_t commands_total = 0;
  Outcome outcome = Outcome::kRunning;
  std::string reason;  ///< why aborted; empty else
};

/// The last executions, oldest first.
class ExecutionLog {
 public:
  static constexpr size_t kCapacity = 8;

  /// A new execution begins; the oldest record leaves if the log is full.
  void begin(int64_t run_id, const Slot& slot, int64_t start_utime);
  /// One more command of the running execution was given to the controller.
  void countCommand();
  /// The running execution is over. Nothing happens if none is running.
  void close(Outcome outcome, int64_t end_utime, const std::string& reason);

  const std::deque<ExecutionRecord>& records() const { return records_; }
  /// Counts up whenever an execution begins or ends.
  uint64_t revision() const { return revision_; }

 private:
  bool running() const { return !records_.empty() && records_.back().outcome == Outcome::kRunning; }

  std::deque<ExecutionRecord> records_;
  uint64_t revision_ = 0;
};

}  // namespace tread::motor
