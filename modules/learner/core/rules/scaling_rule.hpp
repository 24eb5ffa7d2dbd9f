// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "modules/learner/core/rules/stored_predictions.hpp"

namespace tread::learner {

/// Common part of collective and telescoping scaling: the executed pattern is smoothed by equation
/// (2), all others are scaled by one factor per axis.
class ScalingRule : public StoredPredictions {
 public:
  ScalingRule(const RuleConfig& config, const PatternSet& shipped);

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) final;
  std::string reason(const RuleNote& note) const override {
    return std::isfinite(note.scaling[0]) ? "own prediction moved, the others scaled"
                                          : "own prediction moved";
  }

 protected:
  /// Boxes of M, and of the executed pattern's prediction before and after the update.
  struct Boxes {
    Axes measured, before, after;
  };
  /// The factors for the other patterns; fills `note.scaling`.
  virtual Axes factors(const Boxes& boxes, const PatternRole& role, RuleNote& note) const = 0;

  ScalingLimits limits_;

 private:
  /// Sets the guards of `note`; true if a V may be computed from this measurement.
  bool allow(size_t executed, const ConstTrajectory& measured, const Pose2& predicted_end,
             RuleNote& note) const;
  bool opposite(size_t executed, int axis, double measured, double predicted) const;

  std::vector<PatternRole> roles_;
  std::vector<Axes> variances_;  ///< of the shipped ends; NaN = unknown
  double sign_sigmas_;
};

}  // namespace tread::learner
