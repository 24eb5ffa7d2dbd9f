// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "common/execution/execution_record.hpp"
#include "modules/motor_bridge/core/program.hpp"

namespace tread::motor {

/// The most recent executions, oldest first.
class ExecutionLog {
 public:
  static constexpr size_t kCapacity = 8;

  /// Starts a new execution; if the log is full, the oldest record is dropped.
  void begin(int64_t run_id, const ProgramSlot& slot, int64_t start_utime);
  /// One more command of the running execution was given to the controller.
  void countCommand();
  /// Ends the running execution. Does nothing if none is running.
  void close(ExecutionOutcome outcome, int64_t end_utime, const Reason& reason);

  const std::deque<ExecutionRecord>& records() const { return records_; }
  /// Increases whenever an execution begins or ends.
  uint64_t revision() const { return revision_; }

 private:
  bool running() const {
    return !records_.empty() && records_.back().outcome == ExecutionOutcome::kRunning;
  }

  std::deque<ExecutionRecord> records_;
  uint64_t revision_ = 0;
};

/// The player's verdict on an offered program.
enum class Offer {
  kAccepted,         ///< continues, replaces the next slot, or may start
  kStop,             ///< empty running slot: the planner wants to stand
  kPlannerAhead,     ///< names the pending slot as running, shortly before the switch: tolerated
  kPlannerBehind,    ///< names the slot just ended as running, shortly after the switch: tolerated
  kAlreadyExecuted,  ///< refused: the player is idle, and the running slot was played before
  kRunningUnknown,   ///< refused: the running slot is neither played nor pending
  kRunningAltered,   ///< refused: same execution id, other commands
  kNextOutOfOrder,   ///< refused: the next slot's id is not above the running one's
};

/// Whether the planner and the player agree on what is being played.
/** If they disagree, the program must not renew the lease of a moving robot. */
bool agrees(Offer offer);
/// The verdict in words, e.g. "running slot is neither played nor pending".
const char* describe(Offer offer);

/// Plays command series at their fixed period and continues with the next one without a gap.
/** The schedule is start + T * period, never "now", so that a chain of series does not drift.
 *   1. offer() takes programs as they arrive; 2. advance() moves the schedule to now;
 *   3. start() begins an offered series on an idle player; 4. give() returns the command of now. */
class SeriesPlayer {
 public:
  /// A planner may announce a switch this much too early or too late [us]: two of its cycles.
  static constexpr int64_t kSwitchTolerance = 100'000;

  /// Events while the schedule advanced.
  struct Advance {
    bool ended = false;     ///< the last series ended without a pending one
    bool switched = false;  ///< the pending series began
    int32_t skipped = 0;    ///< commands whose whole period passed between two calls
  };

  /// Executions of this run follow; only while idle. Returning to a recent run is harmless: its
  /// executions are not repeated.
  void beginRun(int64_t run_id);
  std::optional<int64_t> runId() const { return run_id_; }

  /// Takes a checked program of the current run, received at now [us].
  Offer offer(const Program& program, int64_t now);
  /// Advances the schedule to now [us].
  Advance advance(int64_t now);
  /// Whether the newest offer may start on this idle player.
  bool startable() const { return !playing() && !candidate_.running.empty(); }
  /// Starts the offered series at now [us]; needs startable().
  void start(int64_t now);
  /// A series starts only in the step in which its program arrived: later the program would be
  /// outdated.
  void dropCandidate() { candidate_ = Program{}; }
  /// Ends the running series at now [us] and drops the pending one.
  void abort(int64_t now, const Reason& reason);
  /// Command of the current period, counted as given to the controller; requires playing().
  Command give();

  bool playing() const { return !current_.empty(); }
  const ProgramSlot& current() const { return current_; }
  const ProgramSlot& pending() const { return pending_; }
  int32_t index() const { return index_; }  ///< 0-based within the running series
  const ExecutionLog& log() const { return log_; }

 private:
  Offer offerIdle(const Program& program);
  Offer offerPlaying(const Program& program, int64_t now);
  void begin(const ProgramSlot& slot, int64_t start_utime);
  int64_t endUtime() const { return start_utime_ + current_.durationUs(); }

  static constexpr size_t kRunsRemembered = 8;

  std::optional<int64_t> run_id_;
  std::map<int64_t, int64_t> executed_by_run_;  ///< highest execution id of earlier runs
  int64_t last_executed_ = 0;                   ///< highest execution id started in this run
  int64_t previous_id_ = 0;  ///< the execution before the current one without a gap; 0 = none
  ProgramSlot current_;
  ProgramSlot pending_;
  Program candidate_;
  int64_t start_utime_ = 0;
  int32_t index_ = 0;
  int32_t given_ = 0;  ///< commands of the current series up to this index are accounted for
  ExecutionLog log_;
};

}  // namespace tread::motor
