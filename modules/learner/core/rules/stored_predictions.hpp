// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

/// Rules that know nothing but the predictions themselves: all that they learn is in a table.
class StoredPredictions : public LearningRule {
 public:
  explicit StoredPredictions(const PatternSet& shipped) : table_(shipped.patterns()) {}

  void predict(size_t pattern, Trajectory prediction) const override {
    prediction = table_.of(pattern);
  }
  Pose2 predictEnd(size_t pattern) const override { return table_.end(pattern); }
  void assign(const LearningRule& other) override {
    table_.copyNumbers(static_cast<const StoredPredictions&>(other).table_);
  }
  /// What another rule remembered is of no use here, what it predicted is.
  bool restore(const TrajectoryTable& predictions, const std::vector<double>&) override {
    if (!table_.sameShape(predictions)) return false;
    table_.copyNumbers(predictions);
    return true;
  }

 protected:
  TrajectoryTable table_;
};

}  // namespace tread::learner
