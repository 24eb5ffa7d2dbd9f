// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/messages/command_watch.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/pattern/pattern.hpp"
#include "common/store/store.hpp"
#include "modules/learner/core/grip.hpp"
#include "modules/learner/core/hand_watch.hpp"
#include "modules/learner/core/learner.hpp"
#include "modules/learner/learner_memory.hpp"
#include "modules/learner/shock_publisher.hpp"

namespace tread::learner {

/// Configuration of the learner process; the shell reads the shipped set from its file.
struct LearnerNodeConfig {
  PatternSet shipped;  ///< where learning begins
  RuleConfig rule;
  MeasurementLimits limits;
  int64_t period_us = 20'000;   ///< [us] between steps
  int64_t settle_us = 200'000;  ///< [us] after which a message must have arrived: INS latency and
                                ///< disorder of the bus
  int64_t give_up_us = 2'000'000;  ///< [us] after its end at which an execution is measured with
                                   ///< the INS data available
  int64_t follow_us =
      200'000;  ///< [us] period of learning from a running execution; 0 = only at its end
  int64_t repeat_us = 2'000'000;       ///< [us] between repetitions of the set
  int64_t track_span_us = 60'000'000;  ///< [us] of INS data that are kept
  int64_t listen_us = 0;  ///< [us] without publishing sets at the start, to detect another learner
  bool shock = false;     ///< learn how strongly ground shakes the robot, and publish it
  double front = 0.0;     ///< [m] from the body origin to the front end, where shock is measured
  /// Sets kept to score executions with the version that they name
  int64_t remembered_versions = 50;

  std::string store = "state/learner";  ///< folder of the state; used by the process
  std::vector<std::string> warnings;    ///< about given keys that the rule does not use

  explicit LearnerNodeConfig(PatternSet set) : shipped(std::move(set)) {}
  /// The configuration with its defaults, for CONFIG.
  std::string effective() const;
};

/// The keys among memory, scaling and ground that a rule uses.
std::vector<std::string> keysReadBy(const Rule& rule);

/// Reads the configuration and the pattern file that it names; throws ConfigError with file:line.
LearnerNodeConfig readLearnerConfig(ConfigReader& reader);

/// Reads everything except the pattern file into `config`; does not finish() the reader.
void readLearnerSettings(ConfigReader& reader, LearnerNodeConfig& config);

/// The learner process. INS, EXECUTION, MOTOR, MAP in; PATTERN_SET, LEARNER_STATE, LEARNING, SHOCK,
/// GRIP, HEALTH, CONFIG out.
/** 1. Inputs wait until they are settle_us old and are then taken in the order of (utime, seq).
 *  2. An execution is cut, gated and scored against the set version that its record names. Manual
 *     driving whose commands equal a pattern's, or the beginning of one, is an execution, too: of
 *     run 0, with the time of its start as id.
 *  3. If the rule changes the set, state and set are written and published under the next version.
 *  4. A rule that learns from parts follows a running execution: sets are published as if it had
 *     ended there, but neither written nor reported. The final result replaces them.
 *  5. With `shock` it also learns from INS and MAP how strongly ground shakes the robot
 *     (ShockPublisher).
 *  6. From executions that are valid, or refused only for their entry, it estimates the available
 *     deceleration (GripEstimator), also while they run, and publishes it.
 *
 * Each (run id, execution id) is handled once. Versions only increase: see LearnerMemory. While a
 * learner that was started earlier lives, this one neither publishes nor learns; then it continues
 * above the versions of that one. */
class LearnerNode : public Node {
 public:
  LearnerNode(LearnerNodeConfig config, Bus& bus, Store& store);

  /// Continues with exactly that version, without a new number: for a replay that begins with a
  /// log.
  /** `earlier`: previous sets that executions may still name. Call before the first step. */
  void resume(LearnerState state, const std::vector<PatternSet>& earlier);

  /// Publishes other sets than the learned ones, which are still used for scoring executions. Call
  /// before the first step.
  void replaceSets(SetReplacement replacement) {
    publisher_.replaceSets(std::move(replacement));
    publisher_.putSet(learner_.set());
  }

  int64_t period() const override { return config_.period_us; }
  void step(int64_t utime) override;

  const PatternSet& set() const { return learner_.set(); }
  /// Number of surfaces that the rule remembers.
  int rememberedSurfaces() const { return std::max(0, learner_.rule().remembered()); }
  /// The state as it is written to disk.
  std::string stateText() const;

 private:
  void start(int64_t boot_time);
  void hear(const execution_t& message);
  void hear(const motor_t& motor);
  void noteVersion(int64_t version);
  bool listensOnly() const;
  bool mustBePassive(int64_t utime) const;
  void becomeActive();
  void handleEnded(int64_t utime);
  void handle(const execution_record_t& record);
  void noteRunning(const execution_t& message);
  void followRunning(int64_t until);
  void feelGrip(const ExecutionCut& cut, const Measurement& measurement, int pattern_id);
  void publishGrip(int64_t utime);
  ExecutionCut cutOf(const execution_record_t& record, const MotionPattern& pattern) const;
  Measurement measureCut(const ExecutionCut& cut, const MotionPattern& pattern) const;
  void score(const execution_record_t& record, const Measurement& measurement,
             learning_t& message) const;
  void scoreAfter(const Measurement& measurement, int pattern_id, learning_t& message) const;
  std::optional<Pose2> scoredError(const execution_record_t& record,
                                   const Measurement& measurement) const;
  const MotionPattern* patternOf(int64_t version, int pattern_id) const;
  void keepVersion();
  void goAbove(int64_t version);
  void adoptVersion();
  void publishVersion();
  void noteWrite(const std::optional<std::string>& problem);
  void reportHealth(int64_t utime);

  LearnerNodeConfig config_;
  Bus& bus_;
  Learner learner_;
  LearnerMemory memory_;
  InsQueue ins_;
  ExecutionQueue executions_;
  CommandWatch commands_;
  HandWatch hand_;
  std::optional<execution_record_t> running_;  ///< the followed execution
  int64_t followed_until_ = 0;                 ///< [us] of its time
  int64_t seq_motor_ = -1;                     ///< of the last MOTOR; -1 = none yet
  SetPublisher publisher_;
  HealthReporter health_;
  std::optional<ShockPublisher> shock_;
  GripEstimator grip_;
  int64_t grip_felt_ = 0;  ///< [us] end of the newest execution with evidence
  int64_t next_grip_ = 0;  ///< [us]
  int64_t seq_grip_ = 0;
  std::map<int64_t, PatternSet> versions_;  ///< the last sets by version
  /// Versions above ours that records named, with counts
  std::map<int64_t, int> unknown_versions_;
  std::string start_problem_;
  std::string write_problem_;
  int64_t highest_heard_ = 0;  ///< highest version that was named by others and accepted
  bool passive_ = false;
  int64_t steps_ = 0;
  int64_t next_repeat_ = 0;
  int64_t seq_learning_ = 0;
};

}  // namespace tread::learner
