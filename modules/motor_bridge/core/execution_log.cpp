// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/execution_log.hpp"

namespace tread::motor {

void ExecutionLog::begin(int64_t run_id, const Slot& slot, int64_t start_utime) {
  ExecutionRecord record;
  record.run_id = run_id;
  record.execution_id = slot.execution_id;
  record.pattern_id = slot.pattern_id;
  record.set_version = slot.set_version;
  record.start_utime = start_utime;
  record.commands_total = static_cast<int32_t>(slot.series.size());
  records_.push_back(record);
  if (records_.size() > kCapacity) {
    records_.pop_front();
  }
  ++revision_;
}

void ExecutionLog::countCommand() {
  if (running()) {
    ++records_.back().commands_played;
  }
}

void ExecutionLog::close(Outcome outcome, int64_t end_utime, const std::string& reason) {
  if (!running()) {
    return;
  }
  records_.back().outcome = outcome;
  records_.back().end_utime = end_utime;
  records_.back().reason = reason;
  ++revision_;
}

}  // namespace tread::motor
