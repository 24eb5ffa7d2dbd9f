// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "modules/learner/core/rules/scaling_rule.hpp"

namespace tread::learner {

/// Collective Motion Pattern Scaling, the paper's algorithm (section IV, Algorithm 1; Table I
/// column c).
/** From the measured trajectory M of the executed pattern MP* and its prediction R* before the
 * update, with boxes that include the start pose, x and y [m], yaw interval [rad]:
 *    V = (x_s, y_s, phi_s) = box(M) / box(R*)                                     equation (1)
 *    R* <- (1 - w) M + w R*                                                       equation (2)
 *    R_p <- (1 - w) V R_p + w R_p   for every other pattern p                     equation (2)
 * with w the weight of the old prediction (equation (2); line 13 of Algorithm 1 swaps the roles).
 * Guards, see scaling.hpp: an axis whose shipped box is noise keeps the factor 1 permanently; a
 * one-dimensional pattern, with noise on two axes, gives no V, nor does a measurement in the
 * opposite direction; V is limited. Known faults: on unchanged ground the predictions of patterns
 * that are never driven drift, because the mean of a quotient of noisy boxes is not 1 (Telescoping
 * avoids this); and because every pattern gets the same factor, the ratios between patterns stay
 * those of the shipped set, even if all are measured exactly (true of telescoping as well). */
class Collective : public ScalingRule {
 public:
  using ScalingRule::ScalingRule;

  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<Collective>(*this);
  }

 protected:
  Axes factors(const Boxes& boxes, const PatternRole& role, RuleNote& note) const override {
    note.scaling = scalingVector(boxes.measured, boxes.before, role, limits_);  // equation (1)
    return (1.0 - memory_) * note.scaling + memory_;  // equation (2) with M = V R
  }
};

}  // namespace tread::learner
