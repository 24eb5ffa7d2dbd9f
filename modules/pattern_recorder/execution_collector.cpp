// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/pattern_recorder/execution_collector.hpp"

#include <array>
#include <cstdio>
#include <utility>

namespace tread::pattern_recorder {
namespace {

constexpr int64_t kTrackSpan = 30'000'000;   // [us] of INS that is kept
constexpr int64_t kSettle = 200'000;         // [us] what is this old has arrived
constexpr int64_t kGiveUpAfter = 2'000'000;  // [us] after its end an execution is judged anyhow
constexpr double kDegrees = 180.0 / kPi;

}  // namespace

ExecutionCollector::ExecutionCollector(const PatternSet& set, int64_t run_id, int wanted,
                                       int give_up_after, const MeasurementLimits& limits, Say say)
    : set_(set),
      run_id_(run_id),
      wanted_(wanted),
      give_up_after_(give_up_after),
      limits_(limits),
      say_(std::move(say)),
      ins_(kTrackSpan),
      recorded_(set.patterns().size()),
      refused_in_a_row_(set.patterns().size(), 0) {
  if (limits_.max_speed <= 0.0) limits_.max_speed = largestSpeed(set_);
}

std::vector<int64_t> ExecutionCollector::judge(int64_t utime) {
  std::vector<int64_t> judged;
  const int64_t horizon = utime - kSettle;
  ins_.settle(horizon);
  for (auto end = executions_.nextEnd(); end; end = executions_.nextEnd()) {
    const bool passed = ins_.history().newest() >= *end;
    if (!passed && horizon < *end + kGiveUpAfter) break;
    const execution_record_t record = *executions_.takeEndedBy(*end);
    if (record.record_run_id != run_id_) continue;
    judged.push_back(record.record_execution_id);
    judge(record);
  }
  return judged;
}

void ExecutionCollector::judge(const execution_record_t& record) {
  for (size_t p = 0; p < set_.patterns().size(); ++p) {
    const MotionPattern& pattern = set_.patterns()[p];
    if (pattern.id != record.record_pattern_id) continue;
    Measurement measured = measure(record, pattern);
    if (!measured.fair())
      refuse(p, measured.gate, measured.reason);
    else if (!measured.complete())
      refuse(p, Gate::kCoveredTime, "the INS does not cover its end");
    else
      keep(p, std::move(measured.trajectory));
  }
}

Measurement ExecutionCollector::measure(const execution_record_t& record,
                                        const MotionPattern& pattern) const {
  ExecutionCut cut;
  cut.started = record.started;
  cut.ended = record.ended;
  cut.completed = record.outcome == execution_record_t::OUTCOME_COMPLETED;
  cut.outcome_reason = record.outcome_reason;
  cut.unexpected_command = commands_.unexpectedCommand({record.record_run_id, record.record_execution_id},
                                                 pattern, set_.content().kind);
  return tread::measure(ins_.history(), cut, pattern, set_.classNamed(pattern.entry_class),
                        set_.content().period_us, limits_);
}

void ExecutionCollector::keep(size_t pattern, std::vector<Pose2> measured) {
  refused_in_a_row_[pattern] = 0;
  // Patterns that only led into a class or back home may be driven more often than wanted.
  if (missing(pattern) <= 0) return;
  const Pose2 end = measured.back();
  recorded_[pattern].push_back(std::move(measured));
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "%s %zu of %d: ends %.3f m ahead, %.3f m to the left, turned %.1f deg",
                set_.patterns()[pattern].name.c_str(), recorded_[pattern].size(), wanted_, end.x,
                end.y, end.yaw * kDegrees);
  say_(text.data());
}

void ExecutionCollector::refuse(size_t pattern, Gate gate, const std::string& reason) {
  if (missing(pattern) <= 0) return;
  ++refused_;
  const std::string& name = set_.patterns()[pattern].name;
  say_(name + " refused, it will be repeated: " + reason);
  // A stop by the operator or a failsafe says nothing of the pattern.
  if (gate == Gate::kAborted || ++refused_in_a_row_[pattern] < give_up_after_) return;
  hopeless_ = name + " was refused " + std::to_string(give_up_after_) +
              " times in a row, the last time: " + reason;
}

std::vector<int> ExecutionCollector::missing() const {
  std::vector<int> missing;
  for (size_t p = 0; p < recorded_.size(); ++p) missing.push_back(this->missing(p));
  return missing;
}

}  // namespace tread::pattern_recorder
