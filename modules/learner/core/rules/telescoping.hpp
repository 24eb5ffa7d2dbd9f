// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/collective.hpp"

namespace tread::learner {

/// Collective scaling without its drift: the others follow the change of the executed pattern.
/** Own work after the paper's idea. With the guards of Collective:
 *    R*_new = (1 - w) M + w R*_old                                                equation (2)
 *    R_p <- R_p box(R*_new) / box(R*_old)   for every other pattern p, axis by axis
 * Over many executions the quotients telescope to box(R*_now) / box(R*_first): what the others got
 * is never more than what the executed pattern itself learned. */
class Telescoping : public StoredPredictions {
 public:
  Telescoping(const RuleConfig& config, const PatternSet& shipped)
      : StoredPredictions(shipped),
        guards_(config, shipped),
        limits_(config.scaling),
        memory_(config.memory) {}

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) override;
  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<Telescoping>(*this);
  }

 private:
  ScalingGuards guards_;
  ScalingLimits limits_;
  double memory_;
};

}  // namespace tread::learner
