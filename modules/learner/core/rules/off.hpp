// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "modules/learner/core/rules/stored_predictions.hpp"

namespace tread::learner {

/// No learning: R stays the shipped prediction whatever is measured (paper, Table I column a).
class Off : public StoredPredictions {
 public:
  using StoredPredictions::StoredPredictions;

  void learn(size_t, const ConstTrajectory&, RuleNote&) override {}
  bool learns() const override { return false; }
  std::unique_ptr<LearningRule> clone() const override { return std::make_unique<Off>(*this); }
};

}  // namespace tread::learner
