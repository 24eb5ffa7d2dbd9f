// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "tools/lab/experiment/adaptation/rivals.hpp"

namespace tread::adaptation {

/// A learner on the pieces of one walk.
class Walker {
 public:
  virtual ~Walker() = default;
  virtual void learn(size_t piece) = 0;
  /// Poses after each sample, relative to the piece's start.
  virtual std::vector<Pose2> predict(size_t piece) const = 0;
  /// Of the last of them; nothing of who does not know it.
  virtual std::optional<PoseCovariance> endCovariance(size_t /*piece*/) const {
    return std::nullopt;
  }
};

/// A session, and what the reference says of it.
struct Known {
  const SampledSession& session;
  Predicted reference;
};

Known knownOf(const SampledSession& session, const Reference& reference, const NoiseModel& noise);

/// A run of pieces of a training session that a rule has driven before, drawn by chance.
/** Empty where there is no session. */
struct TrainingRun {
  const Known* known = nullptr;
  size_t begin = 0, end = 0;
};
TrainingRun drawnHistory(const std::vector<Known>& home, uint64_t seed);

/// A rule of the learner in a session: its set is made of the pieces of its history, which it
/// executes at once, and of the pieces [first, last) of the session.
std::unique_ptr<Walker> ruleWalker(const learner::RuleConfig& config, const TrainingRun& history,
                                   const Known& known, size_t first, size_t last);
/// A copy of a rival that was tuned beforehand.
std::unique_ptr<Walker> rivalWalker(const Rival& fresh, const Known& known);
/// Knows the whole session and learns no more.
std::unique_ptr<Walker> hindsightWalker(const Known& known);

}  // namespace tread::adaptation
