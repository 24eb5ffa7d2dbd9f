// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "common/pattern/pattern.hpp"
#include "modules/planner/core/execution/situation.hpp"

namespace tread::planner {

/// A pattern handed over to the motor bridge, with the set that its prediction was made with.
struct Slot {
  int64_t execution_id = 0;  ///< counts up within a run; 0 = empty
  int pattern_id = 0;
  std::optional<PatternSet> set;  ///< keeps its version even when a newer one has come

  bool empty() const { return execution_id == 0; }
  const MotionPattern& pattern() const { return *set->find(pattern_id); }
  int64_t durationUs() const {
    return set->content().period_us * static_cast<int64_t>(pattern().commands.size());
  }
};

/// Keeps account of what was handed over and of what the bridge made of it.
/** The bridge joins `next` to `running` by itself; the book turns the page when MOTOR or EXECUTION
 * says so or, should they be late, when the running pattern must have ended. */
class ProgramBook {
 public:
  explicit ProgramBook(int64_t run_id) : run_id_(run_id) {}

  /// What became of the running pattern.
  enum class Event { kNone, kSwitched, kEnded, kAborted, kNeverStarted };

  /// Hands over a pattern to a standing vehicle.
  void begin(const PatternSet& set, int pattern_id, int64_t now);
  /// Hands over the pattern that follows; the same pattern again keeps its slot.
  void setNext(const PatternSet& set, int pattern_id);
  void clearNext();
  /// Empties both slots: stop now.
  void stop();
  /// Learns what the bridge does. Call before anything else in a step.
  Event follow(const Situation& situation);

  /// Why a set cannot take the place of the one that was driven with: what was handed over has
  /// other commands in it, or none. Empty if it can.
  std::string clash(const PatternSet& set) const;

  const Slot& running() const { return running_; }
  const Slot& next() const { return next_; }
  /// The bridge has begun the running pattern.
  bool confirmed() const { return confirmed_; }
  /// [us] when the running pattern began, as well as is known.
  int64_t started() const { return started_; }
  int64_t ends() const { return started_ + running_.durationUs(); }
  int64_t runId() const { return run_id_; }
  /// Why the last execution was aborted, in words.
  const std::string& abortReason() const { return abort_reason_; }

 private:
  Event readMotor(const Situation& situation);
  Event readExecutions(const Situation& situation);
  Event watchTime(int64_t now);
  void turnPage(const Slot& to, int64_t started);
  Event leave(Event event, const std::string& reason);
  bool adopt(int64_t execution_id, int64_t started);

  int64_t run_id_;
  int64_t last_id_ = 0;
  Slot running_;
  Slot next_;
  std::deque<Slot>
      replaced_;  ///< handed over as next and replaced: the bridge may have been quicker
  int64_t previous_id_ = 0;
  int64_t handed_over_ = 0;
  int64_t started_ = 0;
  bool confirmed_ = false;
  std::string abort_reason_;
};

}  // namespace tread::planner
