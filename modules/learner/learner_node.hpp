// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/health.hpp"
#include "common/messages/execution_messages.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/store/store.hpp"
#include "modules/learner/core/learner.hpp"
#include "modules/learner/learner_config.hpp"
#include "modules/learner/learner_memory.hpp"
#include "modules/learner/set_publisher.hpp"

namespace tread::learner {

/// The learner process. INS, EXECUTION, MOTOR in; PATTERN_SET, LEARNER_STATE, LEARNING, HEALTH,
/// CONFIG out.
/** 1. Inputs wait until they are settle_us old and are then taken in the order of (utime, seq).
 *  2. An execution is cut, gated and scored against the set version that its record names.
 *  3. If the rule changes the set, state and set are written and published under the next version.
 *  Each (run id, execution id) is handled once. Versions only go up: see LearnerMemory. */
class LearnerNode : public Node {
 public:
  LearnerNode(LearnerNodeConfig config, Bus& bus, Store& store);

  /// Goes on as exactly that version, without a new number: for replay, to begin where a log does.
  /** `earlier`: sets before it that executions may still name. Call before the first step. */
  void resume(LearnerState state, const std::vector<PatternSet>& earlier);

  int64_t period() const override { return config_.period_us; }
  void step(int64_t utime) override;

  const PatternSet& set() const { return learner_.set(); }
  /// How many surfaces the rule remembers.
  size_t rememberedSurfaces() const {
    return learner_.rule().bank() == nullptr ? 0 : learner_.rule().bank()->size();
  }
  /// The state as it is written to disk.
  std::string stateText() const;

 private:
  void start(int64_t boot_time);
  void recallBank();
  void hear(const execution_t& message);
  void handle(const execution_record_t& record);
  Measurement measureRecord(const execution_record_t& record, const MotionPattern& pattern) const;
  void score(const execution_record_t& record, const Measurement& measurement,
             learning_t& message) const;
  void scoreAfter(const Measurement& measurement, int pattern_id, learning_t& message) const;
  std::optional<Pose2> scoredError(const execution_record_t& record,
                                   const Measurement& measurement) const;
  const MotionPattern* patternOf(int64_t version, int pattern_id) const;
  void keepVersion();
  void goAbove(int64_t version);
  void adoptVersion();
  void noteWrite(const std::optional<std::string>& problem);
  void reportHealth(int64_t utime);

  LearnerNodeConfig config_;
  Bus& bus_;
  Learner learner_;
  LearnerMemory memory_;
  InsQueue ins_;
  ExecutionQueue executions_;
  CommandWatch commands_;
  SetPublisher publisher_;
  HealthReporter health_;
  std::map<int64_t, PatternSet> versions_;  ///< the last sets by version
  std::map<int64_t, int>
      unknown_versions_;  ///< versions above ours that records named, and how often
  std::string start_problem_;
  std::string write_problem_;
  int64_t next_repeat_ = 0;
  int64_t seq_learning_ = 0;
};

}  // namespace tread::learner
