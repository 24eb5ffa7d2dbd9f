// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "modules/learner/core/rules/scaling_rule.hpp"

namespace tread::learner {

/// Collective scaling without its drift: the other patterns follow the change of the executed
/// pattern.
/** Own work after the paper's idea. With the guards of Collective:
 *    R*_new = (1 - w) M + w R*_old                                                equation (2)
 *    R_p <- R_p box(R*_new) / box(R*_old)   for every other pattern p, axis by axis
 * Over many executions the quotients telescope to box(R*_now) / box(R*_first): the others never
 * change more than the executed pattern itself. */
class Telescoping : public ScalingRule {
 public:
  using ScalingRule::ScalingRule;

  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<Telescoping>(*this);
  }

 protected:
  Axes factors(const Boxes& boxes, const PatternRole& role, RuleNote& note) const override {
    note.scaling = scalingVector(boxes.after, boxes.before, role, limits_);
    return note.scaling;
  }
};

}  // namespace tread::learner
