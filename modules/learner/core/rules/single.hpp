// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "modules/learner/core/rules/stored_predictions.hpp"

namespace tread::learner {

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
