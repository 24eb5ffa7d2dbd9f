// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

/// Rules that know nothing but the predictions themselves: all that they learn is in a table.
class StoredPredictions : public LearningRule {
 public:
  StoredPredictions(const RuleConfig& config, const PatternSet& shipped)
      : memory_(config.memory), table_(shipped.patterns()) {}

  void predict(size_t pattern, Trajectory prediction) const override {
    prediction = table_.of(pattern);
  }
  Pose2 predictEnd(size_t pattern) const override { return table_.end(pattern); }
  void assign(const LearningRule& other) override {
    table_.copyNumbers(static_cast<const StoredPredictions&>(other).table_);
  }
  /// Takes the predictions of another rule, not its memory.
  bool restore(const TrajectoryTable& predictions, const std::vector<double>&) override {
    if (!table_.sameShape(predictions)) return false;
    table_.copyNumbers(predictions);
    return true;
  }

 protected:
  double memory_;  ///< w of equation (2)
  TrajectoryTable table_;
};

/// No learning: R stays the shipped prediction whatever is measured (paper, Table I column a).
class Off : public StoredPredictions {
 public:
  using StoredPredictions::StoredPredictions;

  void learn(size_t, const ConstTrajectory&, RuleNote&) override {}
  bool learns() const override { return false; }
  std::unique_ptr<LearningRule> clone() const override { return std::make_unique<Off>(*this); }
};

/// Single pattern learning, the paper's predecessor (its reference [4]; Table I column b).
/** Only the executed pattern p learns, by equation (2), for x, y [m] and yaw [rad] of each sample:
 *    R_p <- (1 - w) M + w R_p,   0 <= w < 1 the weight of the old prediction. */
class Single : public StoredPredictions {
 public:
  using StoredPredictions::StoredPredictions;

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote&) override {
    smooth(measured, memory_, table_.change(executed));  // equation (2)
  }
  std::unique_ptr<LearningRule> clone() const override { return std::make_unique<Single>(*this); }
};

}  // namespace tread::learner
