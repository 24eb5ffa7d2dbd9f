// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/bus/bus.hpp"
#include "common/pattern/pattern.hpp"
#include "common/store/store.hpp"
#include "modules/learner/core/learner.hpp"

namespace tread::learner {

/// The learner's stored state at its start.
struct StoredLearning {
  std::optional<LearnerState> state;  ///< newest valid one of this shipped set
  int64_t first_version = 1;          ///< next to publish; above every published version
  std::string problem;                ///< one clear line if something was damaged; otherwise empty
};

/// The learner's files. Entries: learner_state_1 and _2, written alternately so that the previous
/// state is kept, and learner_versions, an upper limit of the published versions.
/** Rule of versions: learner_versions is written ahead for a hundred executions before they are
 * used. A start begins above it, because the last versions may have been published from memory
 * while the disk was full. Without it, a start begins above the newest state by the versions of a
 * thousand executions; without a state, at fifty per second of robot time, which is faster than
 * executions can be learned from. A node that then receives a higher version of its own continues
 * above that (LearnerNode). */
class LearnerMemory {
 public:
  explicit LearnerMemory(Store& store) : store_(store) {}

  StoredLearning recall(const PatternSet& shipped, int64_t utime);

  /// Ensures that `version` may be published. Returns one clear line if that could not be written.
  std::optional<std::string> reserve(int64_t version);
  /// Writes the state of a version over the older of the two. Returns one clear line if it could
  /// not be written.
  std::optional<std::string> save(const std::string& state_text);

 private:
  /// nullopt if it is missing, or damaged, which is added to `problem`.
  std::optional<int64_t> storedReserve(std::string& problem) const;

  Store& store_;
  int64_t reserved_ = 0;
  int next_slot_ = 0;
};

/// Replaces a set by another one.
using SetReplacement = std::function<PatternSet(const PatternSet&)>;

/// Sends sets and states in portions: LCM silently loses messages if one publisher sends more than
/// 100 kB in 20 ms.
class SetPublisher {
 public:
  explicit SetPublisher(Bus& bus) : bus_(bus) {}

  /// Sets are converted by this before sending and keep their versions. For experiments.
  void replaceSets(SetReplacement replacement) { replacement_ = std::move(replacement); }
  /// Enqueues the parts of a set; unsent parts of an older one are dropped.
  void putSet(const PatternSet& set);
  /// Enqueues the parts of a state's text, sent after the sets. At most two states wait; further
  /// ones drop the older.
  void putState(const PatternSet& set, const std::string& rule, const std::string& text);

  bool setsSent() const { return sets_.empty(); }
  /// Sends one portion; without sets, states only.
  void step(int64_t utime, bool with_sets = true);

 private:
  Bus& bus_;
  SetReplacement replacement_;
  std::deque<pattern_set_part_t> sets_;
  std::deque<learner_state_t> states_;
  int64_t seq_set_ = 0;
  int64_t seq_state_ = 0;
};

}  // namespace tread::learner
