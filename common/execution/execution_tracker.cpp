// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/execution/execution_tracker.hpp"

#include <algorithm>

namespace tread {
namespace {

constexpr size_t kReplacedKept = 4;
/// MOTOR may be this old while it does not show the last handover yet [us].
constexpr int64_t kSettle = 300'000;
/// A pattern that the bridge has not started after this long will not start [us].
constexpr int64_t kStartLimit = 1'000'000;

/// Why the set cannot provide the pattern of the slot; empty if it can.
std::string conflictOf(const PatternSet& set, const PlannedExecution& slot) {
  if (slot.empty()) return {};
  const MotionPattern& ours = slot.pattern();
  const MotionPattern* const theirs = set.find(slot.pattern_id);
  const std::string where =
      "PATTERN_SET version " + std::to_string(set.version()) + " waits: in it";
  const std::string pattern = " pattern " + std::to_string(ours.id) + " (" + ours.name + ")";
  if (theirs == nullptr) return where + " there is no" + pattern + ", which is under way";
  const bool same_timing = set.content().channels == slot.set->content().channels &&
                           set.content().period_us == slot.set->content().period_us;
  const bool same_ends =
      theirs->entry_class == ours.entry_class && theirs->exit_class == ours.exit_class;
  const bool same_commands = ours.commands == theirs->commands;
  if (same_timing && same_ends && same_commands) return {};
  return where + pattern + ", which is under way, has other " +
         (!same_timing ? "timing"
          : same_ends  ? "commands"
                       : "motion classes");
}

}  // namespace

std::string ExecutionTracker::conflictWith(const PatternSet& set) const {
  std::string why = conflictOf(set, running_);
  if (why.empty()) why = conflictOf(set, next_);
  // The bridge may have started one of these before it was replaced.
  for (const PlannedExecution& slot : replaced_)
    if (why.empty()) why = conflictOf(set, slot);
  return why;
}

void ExecutionTracker::begin(const PatternSet& set, int pattern_id, int64_t now) {
  running_ = {++last_id_, pattern_id, set};
  next_ = {};
  replaced_.clear();
  previous_id_ = 0;
  handed_over_ = started_ = now;
  confirmed_ = false;
}

void ExecutionTracker::setNext(const PatternSet& set, int pattern_id) {
  // A plan with a newer set is a newer decision: its prediction counts.
  const bool same_set = !next_.empty() && next_.set->version() == set.version();
  if (same_set && next_.pattern_id == pattern_id) return;
  clearNext();
  next_ = {++last_id_, pattern_id, set};
}

void ExecutionTracker::clearNext() {
  if (!next_.empty()) replaced_.push_back(next_);
  if (replaced_.size() > kReplacedKept) replaced_.pop_front();
  next_ = {};
}

void ExecutionTracker::stop() {
  running_ = {};
  next_ = {};
  replaced_.clear();
  confirmed_ = false;
}

ExecutionTracker::Event ExecutionTracker::finish(Event event, const Reason& reason) {
  abort_reason_ = reason;
  stop();
  return event;
}

void ExecutionTracker::advanceTo(const PlannedExecution& to, int64_t started) {
  previous_id_ = running_.execution_id;
  running_ = PlannedExecution(to);
  next_ = {};
  replaced_.clear();
  handed_over_ = started_ = started;
  confirmed_ = true;
}

bool ExecutionTracker::adopt(int64_t execution_id, int64_t started) {
  if (!next_.empty() && next_.execution_id == execution_id) {
    advanceTo(next_, started);
    return true;
  }
  const auto found =
      std::find_if(replaced_.begin(), replaced_.end(),
                   [&](const PlannedExecution& slot) { return slot.execution_id == execution_id; });
  if (found == replaced_.end()) return false;
  advanceTo(*found, started);
  return true;
}

ExecutionTracker::Event ExecutionTracker::follow(const RobotReadings& readings) {
  if (running_.empty()) return Event::kNone;
  Event event = followExecutions(readings);
  if (event == Event::kNone) event = followMotor(readings);
  if (event == Event::kNone) event = followTime(readings.now);
  return event;
}

ExecutionTracker::Event ExecutionTracker::followExecutions(const RobotReadings& readings) {
  Event event = Event::kNone;
  bool begun = false;
  bool completed = false;  // our newest execution that the bridge knows
  for (const ExecutionRecord& record : readings.executions) {
    if (record.run_id != run_id_) continue;
    if (record.execution_id > running_.execution_id && adopt(record.execution_id, record.started))
      event = Event::kSwitched;
    const bool is_running = record.execution_id == running_.execution_id;
    const bool is_previous = previous_id_ != 0 && record.execution_id == previous_id_;
    if (!is_running && !is_previous) continue;
    if (record.outcome == ExecutionOutcome::kAborted) return finish(Event::kAborted, record.reason);
    completed = record.completed();
    if (!is_running) continue;
    begun = true;
    started_ = record.started;
  }
  confirmed_ = confirmed_ || begun;
  // The bridge ended a pattern without starting another one of ours: it stands, whatever was handed
  // over as next.
  return completed ? finish(Event::kEnded, {}) : event;
}

ExecutionTracker::Event ExecutionTracker::followMotor(const RobotReadings& readings) {
  if (!readings.bridge) return Event::kNone;
  const BridgeReading& bridge = *readings.bridge;
  if (bridge.run_id == run_id_ && bridge.execution_id != 0) {
    if (bridge.execution_id == running_.execution_id) {
      if (!confirmed_)
        started_ =
            bridge.utime - running_.set->content().period_us * std::max(0, bridge.command_index);
      confirmed_ = true;
    } else if (bridge.execution_id > running_.execution_id &&
               adopt(bridge.execution_id, confirmed_ ? ends() : bridge.utime)) {
      return Event::kSwitched;
    }
    return Event::kNone;
  }
  const bool settled = bridge.utime > handed_over_ + kSettle;
  if (!confirmed_ || !settled || bridge.state == BridgeState::kDriving) return Event::kNone;
  const bool in_time = bridge.utime >= ends() - kSettle;
  return finish(in_time ? Event::kEnded : Event::kAborted, bridge.reason);
}

ExecutionTracker::Event ExecutionTracker::followTime(int64_t now) {
  if (!confirmed_) {
    if (now - handed_over_ <= kStartLimit) return Event::kNone;
    return finish(Event::kNeverStarted,
                  {StopReason::kNotBegun, "motor_bridge did not begin the pattern"});
  }
  if (now < ends()) return Event::kNone;
  if (!next_.empty()) {
    advanceTo(next_, ends());
    return Event::kSwitched;
  }
  return now < ends() + kSettle ? Event::kNone : finish(Event::kEnded, {});
}

}  // namespace tread
