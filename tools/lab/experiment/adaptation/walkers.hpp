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

/// A learner that traverses the pieces of a session.
class Walker {
 public:
  virtual ~Walker() = default;
  virtual void learn(size_t piece) = 0;
  /// Poses after each sample, relative to the piece's start.
  virtual std::vector<Pose2> predict(size_t piece) const = 0;
  /// Covariance of the last pose; nullopt if the method has none.
  virtual std::optional<PoseCovariance> endCovariance(size_t /*piece*/) const {
    return std::nullopt;
  }
};

/// A session and the reference's predictions for it.
struct Known {
  const SampledSession& session;
  Predicted reference;
};

Known knownOf(const SampledSession& session, const Reference& reference, const NoiseModel& noise);

/// A randomly drawn run of pieces of a training session that a rule executes first.
/** Empty if there is no such session. */
struct TrainingRun {
  const Known* known = nullptr;
  size_t begin = 0, end = 0;
};
TrainingRun drawnHistory(const std::vector<Known>& home, uint64_t seed);

/// A learning rule in a session: its set consists of the pieces of its history, which it executes
/// first, and the pieces [first, last) of the session.
std::unique_ptr<Walker> ruleWalker(const learner::RuleConfig& config, const TrainingRun& history,
                                   const Known& known, size_t first, size_t last);
/// A copy of a tuned rival.
std::unique_ptr<Walker> rivalWalker(const Rival& fresh, const Known& known);
/// Fitted to the whole session, without further learning.
std::unique_ptr<Walker> hindsightWalker(const Known& known);

}  // namespace tread::adaptation
