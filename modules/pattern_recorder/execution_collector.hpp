// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/execution/measurement.hpp"
#include "common/messages/command_watch.hpp"
#include "common/messages/execution_queue.hpp"
#include "common/messages/ins_queue.hpp"
#include "common/recordings/recordings.hpp"
#include "modules/pattern_recorder/core/recording_drive.hpp"

namespace tread::pattern_recorder {

/// Cuts the executions of one run out of INS, EXECUTION and MOTOR, as the learner does, and keeps
/// the fair ones of each pattern.
/** What is refused is told with its reason. Patterns are given by their place in the set. */
class ExecutionCollector {
 public:
  /// `wanted` executions of each pattern are kept; `limits` as the learner's, max_speed 0 = the
  /// set's largest.
  ExecutionCollector(const PatternSet& set, int64_t run_id, int wanted, int give_up_after,
                     const MeasurementLimits& limits, Say say);

  void take(const ins_t& message, int64_t now) { ins_.add(message, now); }
  void take(const motor_t& message) { commands_.add(message); }
  void take(const execution_t& message, int64_t now) { executions_.add(message, now); }

  /// Judges what has ended and is covered by the INS. Returns the execution ids of this run that
  /// were judged.
  std::vector<int64_t> judge(int64_t utime);

  const std::vector<std::vector<recordings::Execution>>& recorded() const { return recorded_; }
  /// Executions still missing, by pattern; 0 = it has all.
  std::vector<int> missing() const;
  int64_t refused() const { return refused_; }
  /// Why it is hopeless: a pattern was refused too often in a row; empty if it is not.
  const std::string& hopeless() const { return hopeless_; }
  const TrackHistory& track() const { return ins_.history(); }

 private:
  int missing(size_t pattern) const {
    return wanted_ - static_cast<int>(recorded_[pattern].size());
  }
  void judge(const execution_record_t& record);
  Measurement measure(const execution_record_t& record, const MotionPattern& pattern) const;
  void keep(size_t pattern, std::vector<Pose2> measured);
  void refuse(size_t pattern, Gate gate, const std::string& reason);

  PatternSet set_;
  int64_t run_id_;
  int wanted_;
  int give_up_after_;
  MeasurementLimits limits_;
  Say say_;
  InsQueue ins_;
  ExecutionQueue executions_;
  CommandWatch commands_;
  std::vector<std::vector<recordings::Execution>> recorded_;
  std::vector<int> refused_in_a_row_;
  int64_t refused_ = 0;
  std::string hopeless_;
};

}  // namespace tread::pattern_recorder
