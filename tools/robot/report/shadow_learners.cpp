// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/report/shadow_learners.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/drive/node_replay.hpp"

namespace tread::report {
namespace {

learner::LearnerNodeConfig withRule(learner::LearnerNodeConfig config, learner::Rule rule) {
  config.rule.rule = rule;
  return config;
}

}  // namespace

/// The learner process of one rule.
class ShadowLearners::Shadow {
 public:
  Shadow(const learner::LearnerNodeConfig& config, learner::Rule rule, int64_t boot_id)
      : replay_(withRule(config, rule), boot_id, [this](const LogEvent& event) { take(event); }) {
    notePredictions(boot_id);
  }

  bool hears(const std::string& channel) const { return replay_.hears(channel); }
  void play(const LogEvent& event) { replay_.play(event); }
  void stepUntil(int64_t utime) { replay_.stepUntil(utime); }

  const std::map<ExecutionKey, learning_t>& reports() const { return reports_; }

  /// Error of a measured end against the prediction at the time of the decision.
  std::optional<PredictionError> errorOf(const learning_t& report, int64_t decided) const {
    const Pose2 end{report.measured_end[0], report.measured_end[1], report.measured_end[2]};
    if (!report.accepted || !std::isfinite(end.x)) return std::nullopt;
    auto newer = std::upper_bound(
        predictions_.begin(), predictions_.end(), decided,
        [](int64_t time, const Predictions& predicted) { return time < predicted.since; });
    if (newer != predictions_.begin()) --newer;
    const auto predicted = newer->ends.find(report.learned_pattern_id);
    if (predicted == newer->ends.end()) return std::nullopt;
    const Pose2& expected = predicted->second;
    return PredictionError{std::hypot(end.x - expected.x, end.y - expected.y),
                           wrapAngle(end.yaw - expected.yaw)};
  }

 private:
  /// The ends of a set's patterns, valid from a time on.
  struct Predictions {
    int64_t since = 0;
    std::map<int, Pose2> ends;  ///< by pattern id
  };

  void take(const LogEvent& event) {
    learning_t report;
    if (decode(event, kLearning, report))
      reports_.insert({{report.learned_run_id, report.learned_execution_id}, report});
    // A planner has a set after its last part.
    const PatternSet& set = replay_.node().set();
    pattern_set_part_t part;
    if (set.version() != version_ && decode(event, kPatternSet, part) &&
        part.set_version == set.version() && part.part + 1 == part.part_count)
      notePredictions(event.utime);
  }

  void notePredictions(int64_t since) {
    const PatternSet& set = replay_.node().set();
    version_ = set.version();
    Predictions predicted;
    predicted.since = since;
    for (const MotionPattern& pattern : set.patterns()) predicted.ends[pattern.id] = pattern.end();
    predictions_.push_back(std::move(predicted));
  }

  NodeReplay<learner::LearnerNode> replay_;
  int64_t version_ = 0;
  std::vector<Predictions> predictions_;  ///< oldest first
  std::map<ExecutionKey, learning_t> reports_;
};

ShadowLearners::ShadowLearners(const learner::LearnerNodeConfig& config,
                               std::vector<learner::Rule> rules, int64_t boot_id)
    : rules_(std::move(rules)), newest_(boot_id) {
  for (const learner::Rule& rule : rules_)
    shadows_.push_back(std::make_unique<Shadow>(config, rule, boot_id));
}

ShadowLearners::~ShadowLearners() = default;

bool ShadowLearners::hears(const std::string& channel) const {
  return !shadows_.empty() && (channel == kProgram.name || shadows_.front()->hears(channel));
}

void ShadowLearners::note(const program_slot_t& slot, int64_t run_id, int64_t utime) {
  if (slot.execution_id == 0) return;
  Decision& known = decisions_[{run_id, slot.execution_id}];
  if (known.pattern_id == slot.slot_pattern_id && known.set_version == slot.slot_set_version)
    return;
  known = {slot.slot_pattern_id, slot.slot_set_version, utime};
}

int64_t ShadowLearners::decisionTime(const ExecutionKey& key) const {
  // A set that arrives in time changes the planner's decision: the planner freezes its command 130
  // ms before an execution, after a step and a search.
  constexpr int64_t kSetInTime = 200'000;
  const auto decided = decisions_.find(key);
  const auto began = began_.find(key);
  if (began == began_.end()) return decided == decisions_.end() ? newest_ : decided->second.since;
  if (decided == decisions_.end()) return began->second;
  return std::max(decided->second.since, began->second - kSetInTime);
}

void ShadowLearners::hear(const LogEvent& event) {
  newest_ = std::max(newest_, event.utime);
  if (!hears(event.channel)) return;
  program_t program;
  if (decode(event, kProgram, program)) {
    note(program.running, program.run_id, program.utime);
    note(program.next, program.run_id, program.utime);
    return;
  }
  execution_t executions;
  if (decode(event, kExecution, executions))
    for (const execution_record_t& record : executions.records)
      began_[{record.record_run_id, record.record_execution_id}] = record.started;
  for (const auto& shadow : shadows_) shadow->play(event);
}

void ShadowLearners::finish() {
  // Longer than a learner waits for missing INS.
  constexpr int64_t kAfterwards = 5'000'000;
  for (const auto& shadow : shadows_) shadow->stepUntil(newest_ + kAfterwards);
}

std::vector<ShadowedExecution> ShadowLearners::executions() const {
  std::vector<ShadowedExecution> executions;
  if (shadows_.empty()) return executions;
  for (const auto& [key, first] : shadows_.front()->reports()) {
    ShadowedExecution execution;
    execution.key = key;
    execution.ended = first.utime;
    const auto began = began_.find(key);
    if (began != began_.end()) execution.began = began->second;
    const int64_t decided = decisionTime(key);
    for (const auto& shadow : shadows_) {
      const auto report = shadow->reports().find(key);
      const auto error = report == shadow->reports().end()
                             ? std::nullopt
                             : shadow->errorOf(report->second, decided);
      if (error) execution.by_rule.push_back(*error);
    }
    // The gates are equal, so either all have measured it or none.
    execution.measured = execution.by_rule.size() == shadows_.size();
    if (!execution.measured) execution.by_rule.clear();
    executions.push_back(std::move(execution));
  }
  std::stable_sort(
      executions.begin(), executions.end(),
      [](const ShadowedExecution& a, const ShadowedExecution& b) { return a.ended < b.ended; });
  return executions;
}

}  // namespace tread::report
