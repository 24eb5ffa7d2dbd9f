// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <tread/program_t.hpp>

#include "common/log/event_log.hpp"
#include "modules/learner/learner_config.hpp"

namespace tread::shadow {

/// An execution by run id and execution id.
using ExecutionKey = std::pair<int64_t, int64_t>;

/// How far an execution ended from what a rule had predicted.
struct EndPoseError {
  double position = 0.0;  ///< [m]
  double yaw = 0.0;       ///< [rad] measured - predicted, wrapped
};

/// One execution with the prediction of each rule.
struct ShadowedExecution {
  ExecutionKey key;
  int64_t began = 0;  ///< [us]; 0 = not known
  int64_t ended = 0;  ///< [us]
  bool measured = false;
  std::vector<EndPoseError> by_rule;  ///< in the order of the rules; empty where not measured
};

/// The learner process once for each rule, beside a drive that goes on without them.
/** They hear INS, EXECUTION and MOTOR of the drive, gate and learn as the robot's learner does, and
 * what they say reaches nobody: the same executions meet every rule. Each begins with the shipped
 * set and without a memory. An execution is scored, for every rule alike, with the newest set that
 * the rule had published when the planner decided on it (PROGRAM; without that, when it began). */
class ShadowLearners {
 public:
  ShadowLearners(const learner::LearnerNodeConfig& config, std::vector<learner::Rule> rules,
                 int64_t boot_id);
  ~ShadowLearners();

  /// A message of the drive, also of channels that do not matter here, at a time of the robot [us],
  /// which must not decrease.
  void hear(int64_t utime, const LogEvent& event);
  /// Whether they listen to this channel at all.
  bool hears(const std::string& channel) const;
  /// After the last message: gives them the time to take in what is under way.
  void finish();

  const std::vector<learner::Rule>& rules() const { return rules_; }
  /// All that every rule has judged so far, in the order in which they ended.
  std::vector<ShadowedExecution> executions() const;

 private:
  class Shadow;
  /// What the planner wanted with an execution, and since when.
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

}  // namespace tread::shadow
