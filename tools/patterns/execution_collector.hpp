// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/recordings/recordings.hpp"
#include "modules/learner/command_watch.hpp"
#include "modules/learner/core/measurement.hpp"
#include "modules/learner/execution_queue.hpp"
#include "modules/learner/ins_queue.hpp"

namespace tread::patterns {

/// Cuts the executions of one run out of INS, EXECUTION and MOTOR, as the learner does, and keeps
/// the fair ones of each pattern.
/** What is refused is told with its reason. Patterns are given by their place in the set. */
class ExecutionCollector {
 public:
  using Say = std::function<void(const std::string& line)>;

  /// `wanted` executions of each pattern are kept; `limits` as the learner's, max_speed 0 = the
  /// set's largest.
  ExecutionCollector(const PatternSet& set, int64_t run_id, int wanted, int give_up_after,
                     const learner::MeasurementLimits& limits, Say say);

  void take(const ins_t& message, int64_t now) { ins_.add(message, now); }
  void take(const motor_t& message) { commands_.add(message); }
  void take(const execution_t& message, int64_t now) { executions_.add(message, now); }

  /// Judges what has ended and is covered by the INS. Returns the execution ids of this run that
  /// were judged.
  std::vector<int64_t> judge(int64_t utime);

  const std::vector<std::vector<recordings::Execution>>& recorded() const { return recorded_; }
  /// Executions that are still missing of a pattern; 0 = it has all.
  int missing(size_t pattern) const {
    return wanted_ - static_cast<int>(recorded_[pattern].size());
  }
  bool complete() const;
  int64_t refused() const { return refused_; }
  /// Why it is hopeless: a pattern was refused too often in a row; empty if it is not.
  const std::string& hopeless() const { return hopeless_; }
  const learner::TrackHistory& track() const { return ins_.history(); }

 private:
  void judge(const execution_record_t& record);
  learner::Measurement measure(const execution_record_t& record,
                               const MotionPattern& pattern) const;
  void keep(size_t pattern, std::vector<Pose2> measured);
  void refuse(size_t pattern, learner::Gate gate, const std::string& reason);

  PatternSet set_;
  int64_t run_id_;
  int wanted_;
  int give_up_after_;
  learner::MeasurementLimits limits_;
  Say say_;
  learner::InsQueue ins_;
  learner::ExecutionQueue executions_;
  learner::CommandWatch commands_;
  std::vector<std::vector<recordings::Execution>> recorded_;
  std::vector<int> refused_in_a_row_;
  int64_t refused_ = 0;
  std::string hopeless_;
};

}  // namespace tread::patterns
