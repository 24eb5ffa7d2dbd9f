// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <tread/execution_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/pattern_set_part_t.hpp>
#include <tread/program_slot_t.hpp>

#include "common/execution/execution_tracker.hpp"
#include "common/pattern/pattern.hpp"

namespace tread {

/// The parts of a set as messages, without utime of sending and seq (the publisher sets seq).
std::vector<pattern_set_part_t> toMessages(const PatternSet& set);

/// Assembles sets from their parts, which may arrive in any order, twice, or not at all.
/** Checks every field before use, the parts of a version against each other, the checksum over the
 * whole, and finally PatternSet::make. Parts of versions not newer than the last returned are
 * skipped silently, because sets are repeated. A broken part costs at most its version's current
 * round of parts. */
class PatternSetAssembler {
 public:
  /// Takes a part. Returns a set if the part completes a valid one that is newer than the last
  /// returned.
  std::optional<PatternSet> add(const pattern_set_part_t& part);

  /// Why the last part or set was refused, in one line; empty if it was accepted.
  const std::string& refusal() const { return refusal_; }
  int64_t refused() const { return refused_; }
  /// Parts of versions before the one in use: from a second learner, or from one that lost its
  /// state.
  int64_t older() const { return older_; }

 private:
  /// A version whose parts are incomplete.
  struct Pending {
    int64_t version = 0;
    std::map<int32_t, pattern_set_part_t> parts;
  };

  std::optional<PatternSet> refuse(const std::string& why);
  Pending& pendingOf(int64_t version);
  std::optional<PatternSet> complete(Pending& pending);

  /// Most recently touched last: a part with a corrupt version number must not displace the true
  /// one.
  std::list<Pending> pending_;
  int64_t last_version_ = 0;
  std::string refusal_;
  int64_t refused_ = 0;
  int64_t older_ = 0;
};

BridgeReading readingFrom(const motor_t& message);
/// Whether the motor bridge may drive in this state (motor_t::STATE_*).
bool mayDrive(int16_t bridge_state);
ExecutionRecord recordFrom(const execution_record_t& message);
std::vector<ExecutionRecord> recordsFrom(const execution_t& message);
/// The command of a MOTOR message; 0 for channels that the robot does not have.
Command commandFrom(const motor_t& message);
/// The kinds of the channels being played; empty while nothing is played.
std::vector<CommandKind> kindsFrom(const motor_t& message);
program_slot_t toMessage(const PlannedExecution& slot);

/// Completed executions that were not learned from yet, in the order in which they ended.
/** EXECUTION repeats the last eight, late, twice or in another order; each is returned exactly
 * once. */
class ExecutionQueue {
 public:
  /// Takes a message; executions that still run are left for a later message.
  /** `now` [us]: a record that ends far after it is broken. */
  void add(const execution_t& message, int64_t now);

  /// The earliest-ended execution if it ended by `horizon` [us]; it counts as handled from now on.
  std::optional<execution_record_t> takeEndedBy(int64_t horizon);

  /// End of the next one [us]; nullopt if none waits.
  std::optional<int64_t> nextEnd() const;

  /// Keys of the most recently handled executions, oldest first.
  std::vector<ExecutionKey> handled() const { return {order_.begin(), order_.end()}; }
  /// Restores the keys that this process handled before its restart.
  void remember(const std::vector<ExecutionKey>& handled);

  /// Invalid records that were dropped.
  int64_t invalid() const { return invalid_; }

 private:
  void noteHandled(const ExecutionKey& key);

  /// By (ended, run, execution)
  std::map<std::tuple<int64_t, int64_t, int64_t>, execution_record_t> waiting_;
  std::set<ExecutionKey> known_;    ///< waiting or handled
  std::deque<ExecutionKey> order_;  ///< handled, oldest first
  int64_t invalid_ = 0;
};

}  // namespace tread
