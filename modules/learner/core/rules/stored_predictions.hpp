// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

/// Rules whose whole knowledge is the table of predictions.
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
  /// Accepts the predictions of another rule, but not its memory.
  bool restore(const TrajectoryTable& predictions, const std::vector<double>&) override {
    if (!table_.sameShape(predictions)) return false;
    table_.copyNumbers(predictions);
    return true;
  }

  /// w of equation (2)
 protected:
  double memory_;
  TrajectoryTable table_;
};

}  // namespace tread::learner
