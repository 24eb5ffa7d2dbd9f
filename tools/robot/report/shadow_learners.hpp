// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tread/program_t.hpp>

#include "common/drive/drive_log.hpp"
#include "modules/learner/learner_node.hpp"

namespace tread::report {

/// Distance of an execution's measured end from the predicted one.
struct PredictionError {
  double position = 0.0;  ///< [m]
  double yaw = 0.0;       ///< [rad] measured - predicted, wrapped
};

/// One execution with the prediction of each rule.
struct ShadowedExecution {
  ExecutionKey key;
  int64_t began = 0;  ///< [us]; 0 = not known
  int64_t ended = 0;  ///< [us]
  bool measured = false;
  std::vector<PredictionError> by_rule;  ///< in the order of the rules; empty if not measured
};

/// One learner process for each rule, all with the messages of one drive.
/** Each receives INS, EXECUTION and MOTOR, gates and learns like the robot's learner. Its messages
 * are discarded, so every rule processes the same executions. Each starts with the shipped set and
 * without memory. A rule's prediction of an execution comes from the newest set that it had
 * published when the planner decided on the execution (by PROGRAM; otherwise, when it began). */
class ShadowLearners {
 public:
  ShadowLearners(const learner::LearnerNodeConfig& config, std::vector<learner::Rule> rules,
                 int64_t boot_id);
  ~ShadowLearners();

  /// Processes a message of the drive at its time [us], which must not decrease.
  void hear(const LogEvent& event);
  /// Whether this channel is used.
  bool hears(const std::string& channel) const;
  /// Call after the last message: finishes pending executions.
  void finish();

  const std::vector<learner::Rule>& rules() const { return rules_; }
  /// All executions with predictions so far, ordered by their ends.
  std::vector<ShadowedExecution> executions() const;

 private:
  class Shadow;
  /// The planner's pattern for an execution, and the time of that decision.
  struct Decision {
    int32_t pattern_id = 0;
    int64_t set_version = 0;
    int64_t since = 0;  ///< [us]
  };
  void note(const program_slot_t& slot, int64_t run_id, int64_t utime);
  int64_t decisionTime(const ExecutionKey& key) const;

  std::vector<learner::Rule> rules_;
  std::vector<std::unique_ptr<Shadow>> shadows_;
  std::map<ExecutionKey, Decision> decisions_;
  std::map<ExecutionKey, int64_t> began_;  ///< [us]
  int64_t newest_ = 0;
};

}  // namespace tread::report
