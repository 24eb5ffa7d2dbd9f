// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/program_book.hpp"

#include <algorithm>

namespace tread::planner {
namespace {

constexpr size_t kReplacedKept = 4;
/// MOTOR may be this old when it does not know yet what was handed over [us].
constexpr int64_t kSettle = 300'000;
/// A pattern that the bridge has not begun after this long will not be begun [us].
constexpr int64_t kStartLimit = 1'000'000;

/// Why the set has not got what the slot holds; empty if it has.
std::string clashWith(const PatternSet& set, const Slot& slot) {
  if (slot.empty()) return {};
  const MotionPattern& ours = slot.pattern();
  const MotionPattern* const theirs = set.find(slot.pattern_id);
  const std::string where =
      "PATTERN_SET version " + std::to_string(set.version()) + " waits: in it";
  const std::string pattern = " pattern " + std::to_string(ours.id) + " (" + ours.name + ")";
  if (theirs == nullptr) return where + " there is no" + pattern + ", which is under way";
  const bool same_timing = set.content().kind == slot.set->content().kind &&
                           set.content().period_us == slot.set->content().period_us;
  const bool same_ends =
      theirs->entry_class == ours.entry_class && theirs->exit_class == ours.exit_class;
  const bool same_commands =
      std::equal(ours.commands.begin(), ours.commands.end(), theirs->commands.begin(),
                 theirs->commands.end(), [](const TrackCommand& a, const TrackCommand& b) {
                   return a.left == b.left && a.right == b.right;
                 });
  if (same_timing && same_ends && same_commands) return {};
  return where + pattern + ", which is under way, has other " +
         (!same_timing ? "timing"
          : same_ends  ? "commands"
                       : "motion classes");
}

}  // namespace

std::string ProgramBook::clash(const PatternSet& set) const {
  std::string why = clashWith(set, running_);
  if (why.empty()) why = clashWith(set, next_);
  // The bridge may have begun one of these before it was replaced.
  for (const Slot& slot : replaced_)
    if (why.empty()) why = clashWith(set, slot);
  return why;
}

void ProgramBook::begin(const PatternSet& set, int pattern_id, int64_t now) {
  running_ = {++last_id_, pattern_id, set};
  next_ = {};
  replaced_.clear();
  previous_id_ = 0;
  handed_over_ = started_ = now;
  confirmed_ = false;
}

void ProgramBook::setNext(const PatternSet& set, int pattern_id) {
  if (!next_.empty() && next_.pattern_id == pattern_id) return;
  clearNext();
  next_ = {++last_id_, pattern_id, set};
}

void ProgramBook::clearNext() {
  if (!next_.empty()) replaced_.push_back(next_);
  if (replaced_.size() > kReplacedKept) replaced_.pop_front();
  next_ = {};
}

void ProgramBook::stop() {
  running_ = {};
  next_ = {};
  replaced_.clear();
  confirmed_ = false;
}

ProgramBook::Event ProgramBook::leave(Event event, const std::string& reason) {
  abort_reason_ = reason;
  stop();
  return event;
}

void ProgramBook::turnPage(const Slot& to, int64_t started) {
  previous_id_ = running_.execution_id;
  running_ = Slot(to);
  next_ = {};
  replaced_.clear();
  handed_over_ = started_ = started;
  confirmed_ = true;
}

bool ProgramBook::adopt(int64_t execution_id, int64_t started) {
  if (!next_.empty() && next_.execution_id == execution_id) {
    turnPage(next_, started);
    return true;
  }
  const auto found = std::find_if(replaced_.begin(), replaced_.end(), [&](const Slot& slot) {
    return slot.execution_id == execution_id;
  });
  if (found == replaced_.end()) return false;
  turnPage(*found, started);
  return true;
}

ProgramBook::Event ProgramBook::follow(const Situation& situation) {
  if (running_.empty()) return Event::kNone;
  Event event = readExecutions(situation);
  if (event == Event::kNone) event = readMotor(situation);
  if (event == Event::kNone) event = watchTime(situation.now);
  return event;
}

ProgramBook::Event ProgramBook::readExecutions(const Situation& situation) {
  Event event = Event::kNone;
  bool begun = false;
  bool completed = false;  // the newest of ours that the bridge knows
  for (const ExecutionReading& record : situation.executions) {
    if (record.run_id != run_id_) continue;
    if (record.execution_id > running_.execution_id && adopt(record.execution_id, record.started))
      event = Event::kSwitched;
    const bool is_running = record.execution_id == running_.execution_id;
    const bool is_previous = previous_id_ != 0 && record.execution_id == previous_id_;
    if (!is_running && !is_previous) continue;
    if (record.outcome == ExecutionReading::Outcome::kAborted)
      return leave(Event::kAborted, record.reason);
    completed = record.outcome == ExecutionReading::Outcome::kCompleted;
    if (!is_running) continue;
    begun = true;
    started_ = record.started;
  }
  confirmed_ = confirmed_ || begun;
  // The bridge ended a pattern and began none of ours at once: it stands, whatever was handed over
  // as next.
  return completed ? leave(Event::kEnded, "") : event;
}

ProgramBook::Event ProgramBook::readMotor(const Situation& situation) {
  if (!situation.bridge) return Event::kNone;
  const BridgeReading& bridge = *situation.bridge;
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
  if (!confirmed_ || !settled || bridge.state == BridgeReading::State::kDriving)
    return Event::kNone;
  const bool in_time = bridge.utime >= ends() - kSettle;
  return leave(in_time ? Event::kEnded : Event::kAborted, bridge.reason);
}

ProgramBook::Event ProgramBook::watchTime(int64_t now) {
  if (!confirmed_) {
    if (now - handed_over_ <= kStartLimit) return Event::kNone;
    return leave(Event::kNeverStarted, "motor_bridge did not begin the pattern");
  }
  if (now < ends()) return Event::kNone;
  if (!next_.empty()) {
    turnPage(next_, ends());
    return Event::kSwitched;
  }
  return now < ends() + kSettle ? Event::kNone : leave(Event::kEnded, "");
}

}  // namespace tread::planner
