// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/store/store.hpp"
#include "modules/learner/core/state_text.hpp"

namespace tread::learner {

/// What the learner finds when it starts.
struct StoredLearning {
  std::optional<LearnerState> state;  ///< newest valid one of this shipped set
  int64_t first_version = 1;          ///< to publish now; above everything ever published
  std::string problem;                ///< one clear line if something was damaged; else empty
};

/// The learner's files. Entries: learner_state_1 and _2, written in turn so that the one before is
/// kept, learner_versions, a number that no published version exceeds, and surface_bank, the
/// remembered surfaces.
/** The rule of versions: learner_versions is written ahead, a hundred at a time, before they are
 * used. A start begins above it, because the last versions may have been published from memory
 * while the disk was full. Without it, above the newest state by a thousand; without that, too, at
 * ten per second of robot time, which is faster than executions can be learned from. A node that
 * then still hears of a higher version of its own goes above that (LearnerNode). */
class LearnerMemory {
 public:
  explicit LearnerMemory(Store& store) : store_(store) {}

  StoredLearning recall(const PatternSet& shipped, int64_t utime);

  /// Makes sure that `version` may be published. One clear line if that could not be written.
  std::optional<std::string> reserve(int64_t version);
  /// Writes the state of a version over the older of the two. One clear line if it could not be
  /// written.
  std::optional<std::string> save(const std::string& state_text);

  /// Reads the remembered surfaces into `bank`; true if there were any.
  /** What cannot be read is set aside under another name, never overwritten: `problem` says so, one
   * clear line. */
  bool recallBank(const PatternSet& shipped, SurfaceBank& bank, std::string& problem);
  /// Writes the remembered surfaces if they are others than last time. One clear line if they could
  /// not be written.
  std::optional<std::string> saveBank(const std::string& bank_text);

 private:
  /// Nothing where it is missing, or damaged, which is added to `problem`.
  std::optional<int64_t> storedReserve(std::string& problem) const;

  Store& store_;
  int64_t reserved_ = 0;
  int next_slot_ = 0;
  std::string bank_text_;       ///< as it is in the store
  std::string bank_in_danger_;  ///< why it must not be written; empty = it may
};

}  // namespace tread::learner
